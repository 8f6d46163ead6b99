// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace egocal::detail {

namespace {

double seconds(std::int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

/// The times of a stream under a clock [s], worked out when they are asked for: a drive of a million poses
/// is looked at dozens of times.
class Times {
 public:
  Times(const Trajectory& trajectory, std::int64_t origin_us, const ClockModel& clock)
      : trajectory_(trajectory), origin_us_(origin_us), clock_(clock) {}
  std::size_t size() const { return trajectory_.size(); }
  double operator[](std::size_t i) const {
    const double t = seconds(trajectory_[i].time_us - origin_us_);
    return t + clock_.offset + clock_.rate * (t - clock_.middle);
  }

 private:
  const Trajectory& trajectory_;
  std::int64_t origin_us_;
  ClockModel clock_;
};

/// Median of at most most_periods distances, evenly spread.
template <typename Values>
double median_period(const Values& times, std::size_t most_periods) {
  if (times.size() < 2) return 0;
  std::vector<double> periods;
  const std::size_t each = std::max<std::size_t>(1, times.size() / most_periods);
  for (std::size_t i = 1; i < times.size(); i += each) periods.push_back(times[i] - times[i - 1]);
  std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2),
                   periods.end());
  return periods[periods.size() / 2];
}

/// Where given times lie among those of a stream, looked up in order.
class Lookup {
 public:
  Lookup(const Times& times, double max_gap) : times_(times), max_gap_(max_gap) {}

  struct Found {
    std::size_t before = 0;
    double part = 0;
  };
  std::optional<Found> at(double time) {
    while (from_ + 1 < times_.size() && times_[from_ + 1] <= time) ++from_;
    const double at = times_[from_];
    if (at > time) return std::nullopt;
    const double before = time - at;
    if (before < same_time) return Found{from_, 0};
    if (from_ + 1 >= times_.size()) return std::nullopt;
    const double period = times_[from_ + 1] - at;
    if (period > max_gap_) return std::nullopt;
    return Found{from_, before / period};
  }

 private:
  static constexpr double same_time = 5e-7;  ///< half of a stamp's resolution [s]
  const Times& times_;
  double max_gap_;
  std::size_t from_ = 0;
};

Motion motion_from(const DualQuaternion& a, const DualQuaternion& b) {
  Motion motion;
  motion.a = canonical_sign(a);
  motion.b = canonical_sign(b);
  const auto position = [](const DualQuaternion& q) -> Eigen::Vector3d {
    return 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
  };
  motion.R_a = Eigen::Quaterniond(motion.a.real[0], motion.a.real[1], motion.a.real[2], motion.a.real[3])
                   .toRotationMatrix();
  motion.t_a = position(motion.a);
  motion.t_b = position(motion.b);
  motion.angle_a = rotation_angle(motion.a);
  motion.angle_b = rotation_angle(motion.b);
  return motion;
}

void measure_sizes(Motions& motions) {
  double angle_a = 0, angle_b = 0, length_a = 0, length_b = 0;
  for (const Motion& motion : motions.all) {
    angle_a += motion.angle_a;
    angle_b += motion.angle_b;
    length_a += motion.t_a.norm();
    length_b += motion.t_b.norm();
  }
  const double n = std::max(1.0, static_cast<double>(motions.all.size()));
  motions.rotation = std::sqrt(angle_a * angle_b) / n;
  motions.translation = std::sqrt(length_a * length_b) / n;
}

}  // namespace

DualQuaternion Instants::between(std::size_t i) const {
  const Place& place = places_[i];
  const DualQuaternion& before = (*others_)[place.before].pose;
  return place.part > 0 ? interpolate(before, (*others_)[place.before + 1].pose, place.part) : before;
}

Instants synchronised(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                      std::size_t each, const MotionSampleOptions& options) {
  Instants instants;
  if (a.empty() || b.empty()) return instants;
  const std::int64_t origin_us = a.front().time_us;
  const Times times_a(a, origin_us, {}), times_b(b, origin_us, clock);
  const bool b_slower =
      10 * median_period(times_b, options.most_periods) >= 9 * median_period(times_a, options.most_periods);
  instants.b_slower_ = b_slower;
  instants.keys_ = b_slower ? &b : &a;
  instants.others_ = b_slower ? &a : &b;
  const Times& key_times = b_slower ? times_b : times_a;
  Lookup other(b_slower ? times_a : times_b, max_gap);
  instants.time.reserve(key_times.size() / each + 1);
  instants.places_.reserve(key_times.size() / each + 1);
  for (std::size_t i = 0; i < key_times.size(); i += each) {
    const double time = key_times[i];
    const std::optional<Lookup::Found> found = other.at(time);
    if (!found) continue;
    instants.time.push_back(time);
    instants.places_.push_back({i, found->before, found->part});
  }
  instants.period = median_period(instants.time, options.most_periods);
  return instants;
}

Motions motions_of(const Instants& instants, const PoseReading& read_a, const PoseReading& read_b, int stride,
                   std::size_t most, const MotionSampleOptions& options) {
  Motions motions;
  motions.stride = stride;
  const auto steps = static_cast<std::size_t>(stride);
  const std::size_t n = instants.time.size();
  if (n <= steps) return motions;
  const std::size_t each = std::max<std::size_t>(1, (n - steps) / most);
  motions.all.reserve((n - steps) / each + 1);
  for (std::size_t i = 0; i + steps < n; i += each) {
    const std::size_t k = i + steps;
    if (instants.time[k] - instants.time[i] > options.most_stretched * stride * instants.period) continue;
    Motion motion = motion_from(conjugate(reread(instants.a(i), read_a)) * reread(instants.a(k), read_a),
                                conjugate(reread(instants.b(i), read_b)) * reread(instants.b(k), read_b));
    if (std::max(motion.angle_a, motion.angle_b) > options.most_rotation) continue;
    motion.time = 0.5 * (instants.time[i] + instants.time[k]);
    motions.all.push_back(std::move(motion));
  }
  const std::size_t independent = n / (2 * steps) >= 16 ? n / (2 * steps) : n / steps;
  motions.blocks = std::max<std::size_t>(1, std::min({options.most_blocks, independent, motions.all.size()}));
  measure_sizes(motions);
  return motions;
}

Motions motions_of(std::span<const MotionPair> pairs, const MotionSampleOptions& options) {
  Motions motions;
  for (const MotionPair& pair : pairs) {
    motions.all.push_back(motion_from(normalized(pair.a), normalized(pair.b)));
    motions.all.back().time = static_cast<double>(motions.all.size() - 1);
  }
  motions.blocks = std::max<std::size_t>(1, std::min(options.most_blocks, motions.all.size()));
  measure_sizes(motions);
  return motions;
}

Motions scaled(const Motions& given, double scale_b) {
  Motions motions = given;
  for (Motion& motion : motions.all) {
    motion.t_b *= scale_b;
    motion.b.dual *= scale_b;
  }
  motions.translation = given.translation * std::sqrt(scale_b);
  return motions;
}

}  // namespace egocal::detail
