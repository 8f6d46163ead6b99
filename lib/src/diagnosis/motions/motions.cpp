// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/cut_alike.hpp"
#include "pairing/smooth_interpolation.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

/// Median of at most most_periods distances, evenly spread.
template <typename Time>
double median_period(std::size_t count, const Time& time, std::size_t most_periods) {
  if (count < 2) return 0;
  std::vector<double> periods;
  const std::size_t each = std::max<std::size_t>(1, count / most_periods);
  for (std::size_t i = 1; i < count; i += each) periods.push_back(time(i) - time(i - 1));
  return median(std::move(periods));
}

constexpr double same_time = 5e-7;  ///< half of a stamp's resolution [s]

/// Where given times lie among those of a stream, looked up in order.
class Lookup {
 public:
  Lookup(const Times& times, double max_gap) : times_(times), max_gap_(max_gap) {}

  /// The pose at or before a time, if the streams have one there.
  std::optional<std::size_t> before(double time) {
    const std::size_t from = from_;
    // Streams are mostly regular: it goes on by about as much as the last time. In a long drive of which few
    // poses are looked at, this is most of the work.
    if (from_ + usual_ < times_.size() && times_[from_ + usual_] <= time) from_ += usual_;
    while (from_ + 1 < times_.size() && times_[from_ + 1] <= time) ++from_;
    usual_ = from_ - from > 1 ? from_ - from - 1 : 0;
    const double at = times_[from_];
    if (at > time) return std::nullopt;
    if (time - at < same_time) return from_;
    if (from_ + 1 >= times_.size()) return std::nullopt;
    if (times_[from_ + 1] - at > max_gap_) return std::nullopt;
    return from_;
  }

 private:
  const Times& times_;
  double max_gap_;
  std::size_t from_ = 0;
  std::size_t usual_ = 0;  ///< poses that the last look went on by, less one
};

/// Lengths beyond this are jumps: an origin that is set anew in the middle of the drive is a million times as
/// far away as a motion, and as a part of that mean everything agrees. A vehicle goes at most a few times as
/// fast as in the middle of its way, which is where half of the other stream's way is behind it.
double longest_of_drive(const std::vector<double>& lengths, const std::vector<double>& of_other) {
  constexpr double most = 16;  // times the usual length: stop and go of simulated vehicles reaches 5
  // nor do jumps of the other stream say where its way is
  const double high = quantile(of_other, 0.9);
  const double limit = high > 0 ? most * high : std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, double>> weighted;
  weighted.reserve(lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (of_other[i] > 0) weighted.emplace_back(lengths[i], std::min(of_other[i], limit));
  const double usual = weighted.empty() ? 0 : weighted_median(std::move(weighted));
  return usual > 0 ? most * usual : std::numeric_limits<double>::infinity();
}

double mean_up_to(double longest, const std::vector<double>& lengths) {
  double sum = 0;
  std::size_t count = 0;
  for (const double length : lengths)
    if (length <= longest) {
      sum += length;
      ++count;
    }
  return sum / std::max(1.0, static_cast<double>(count));
}

StampedPose read(const StampedPose& given, const PoseReading& reading) {
  return {given.time_us, reread(given.pose, reading)};
}

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

}  // namespace

void measure_sizes(Motions& motions) {
  std::vector<double> a, b;
  double angle_a = 0, angle_b = 0;
  for (const Motion& motion : motions.all) {
    angle_a += motion.angle_a;
    angle_b += motion.angle_b;
    a.push_back(motion.t_a.norm());
    b.push_back(motion.t_b.norm());
  }
  motions.rotation = std::sqrt(angle_a * angle_b) / std::max(1.0, static_cast<double>(motions.all.size()));
  motions.translation =
      std::sqrt(mean_up_to(longest_of_drive(a, b), a) * mean_up_to(longest_of_drive(b, a), b));
}

double Instants::part_of_way(const Place& place) const {
  const double at = (*other_times_)[place.before];
  const double behind = (*key_times_)[place.key] - at;
  return behind < same_time ? 0 : behind / ((*other_times_)[place.before + 1] - at);
}

std::optional<DualQuaternion> Instants::interpolated_smoothly(const Place& place, double part,
                                                              const PoseReading& read_other) const {
  const std::size_t side = interpolation_.smooth_poses / 2;
  if (place.before + 1 < side || place.before + side >= others_->size()) return std::nullopt;
  std::span<const StampedPose> around = std::span(*others_).subspan(place.before + 1 - side, 2 * side);
  std::array<StampedPose, SynchroniserOptions::most_smooth_poses> other_reading;
  if (!as_given(read_other)) {
    std::transform(around.begin(), around.end(), other_reading.begin(),
                   [&](const StampedPose& given) { return read(given, read_other); });
    around = std::span(other_reading).first(2 * side);
  }
  return interpolate_smoothly(around, part, interpolation_);
}

PosePair Instants::interpolated(std::size_t i, double part, const PoseReading& read_key,
                                const PoseReading& read_other) const {
  const Place& place = places_[i];
  const StampedPose pose = read((*keys_)[place.key], read_key);
  const auto smooth_here = [&] { return interpolated_smoothly(place, part, read_other); };
  const std::optional<DualQuaternion> smooth =
      remembered_ && as_given(read_other) ? remembered_->at(i, smooth_here) : smooth_here();
  if (smooth) return {pose.pose, *smooth};
  const StampedPose from = read((*others_)[place.before], read_other),
                    to = read((*others_)[place.before + 1], read_other);
  const DualQuaternion other = interpolate(from.pose, to.pose, part);
  if (place.key == 0 || place.key + 1 == keys_->size()) return {pose.pose, other};
  const StampedPose before = read((*keys_)[place.key - 1], read_key),
                    after = read((*keys_)[place.key + 1], read_key);
  return {cut_alike({before, pose, after},
                    {part, static_cast<double>(to.time_us - from.time_us), max_gap_us_}, interpolation_),
          other};
}

PosePair Instants::at(std::size_t i, const PoseReading& read_a, const PoseReading& read_b) const {
  const Place& place = places_[i];
  const PoseReading& read_key = b_slower_ ? read_b : read_a;
  const PoseReading& read_other = b_slower_ ? read_a : read_b;
  const double part = part_of_way(place);
  PosePair poses = part > 0 ? interpolated(i, part, read_key, read_other)
                            : PosePair{reread((*keys_)[place.key].pose, read_key),
                                       reread((*others_)[place.before].pose, read_other)};
  if (b_slower_) std::swap(poses.a, poses.b);
  return poses;
}

Instants Instants::remembering() const {
  constexpr std::size_t most = 100'000;  // 65 bytes each
  Instants others = *this;
  others.remembered_ = size() <= most ? std::make_shared<RememberedPoses>(size()) : nullptr;
  return others;
}

Instants Instants::through(std::size_t smooth_poses) const {
  Instants other = *this;
  other.interpolation_.smooth_poses = smooth_poses;
  other.remembered_ = nullptr;
  return other;
}

Instants Instants::without(const std::vector<bool>& wrong) const {
  Instants others = *this;
  others.places_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (!wrong[i]) others.places_.push_back(places_[i]);
  return remembered_ ? others.remembering() : others;
}

void Instants::fetch(std::size_t i) const {
  const auto fetch_poses = [](const Trajectory& poses, std::size_t from, std::size_t to) {
    constexpr std::size_t line = 64;  // bytes that come at once
    const auto* const begin = reinterpret_cast<const char*>(&poses[from]);
    const std::size_t size = (to - from) * sizeof(StampedPose);
    for (std::size_t byte = 0; byte < size; byte += line) __builtin_prefetch(begin + byte);
  };
  if (i >= places_.size()) return;
  const Place& place = places_[i];
  fetch_poses(*keys_, place.key, place.key + 1);
  const std::size_t side = interpolation_.smooth_poses / 2;
  fetch_poses(*others_, place.before + 1 - std::min<std::size_t>(side, place.before + 1),
              std::min(place.before + 1 + side, others_->size()));
}

MotionEnds::MotionEnds(const Instants& instants, const PoseReading& read_a, const PoseReading& read_b,
                       std::size_t steps, std::size_t each)
    : instants_(&instants),
      read_a_(read_a),
      read_b_(read_b),
      each_(each),
      known_(steps % each == 0 ? steps / each + 1 : 0) {}

void MotionEnds::fetch_next(std::size_t i, std::size_t k) const {
  if (known_.empty()) instants_->fetch(i + each_);
  instants_->fetch(k + each_);
}

PosePair MotionEnds::at(std::size_t i) {
  if (known_.empty()) return instants_->at(i, read_a_, read_b_);
  Known& known = known_[i / each_ % known_.size()];
  if (known.end != i + 1) known = {i + 1, instants_->at(i, read_a_, read_b_)};
  return known.poses;
}

Instants synchronised(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                      std::size_t each, const MotionSampleOptions& options) {
  Instants instants;
  if (a.empty() || b.empty()) return instants;
  const std::int64_t origin_us = a.front().time_us;
  const Times times_a(a, origin_us, {}), times_b(b, origin_us, clock);
  const auto period_of = [&options](const Times& times) {
    return median_period(
        times.size(), [&times](std::size_t i) { return times[i]; }, options.most_periods);
  };
  const bool b_slower = 10 * period_of(times_b) >= 9 * period_of(times_a);
  instants.b_slower_ = b_slower;
  instants.keys_ = b_slower ? &b : &a;
  instants.others_ = b_slower ? &a : &b;
  instants.max_gap_us_ = to_microseconds(max_gap);
  const Times& key_times = instants.key_times_.emplace(b_slower ? times_b : times_a);
  Lookup other(instants.other_times_.emplace(b_slower ? times_a : times_b), max_gap);
  instants.places_.reserve(key_times.size() / each + 1);
  for (std::size_t i = 0; i < key_times.size(); i += each)
    if (const std::optional<std::size_t> before = other.before(key_times[i]))
      instants.places_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(*before)});
  instants.period = median_period(
      instants.size(), [&instants](std::size_t i) { return instants.time(i); }, options.most_periods);
  return instants;
}

Motions motions_of(const Instants& instants, const PoseReading& read_a, const PoseReading& read_b, int stride,
                   std::size_t most, const MotionSampleOptions& options) {
  Motions motions;
  motions.stride = stride;
  const auto steps = static_cast<std::size_t>(stride);
  const std::size_t n = instants.size();
  if (n <= steps) return motions;
  const std::size_t each = std::max<std::size_t>(1, (n - steps) / most);
  motions.all.reserve((n - steps) / each + 1);
  MotionEnds ends(instants, read_a, read_b, steps, each);
  for (std::size_t i = 0; i + steps < n; i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k) - instants.time(i) > options.most_stretched * stride * instants.period) continue;
    ends.fetch_next(i, k);
    const PosePair from = ends.at(i), to = ends.at(k);
    Motion motion = motion_from(conjugate(from.a) * to.a, conjugate(from.b) * to.b);
    if (std::max(motion.angle_a, motion.angle_b) > options.most_rotation) continue;
    motion.time = 0.5 * (instants.time(i) + instants.time(k));
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

Motions part_of(const Motions& motions, std::size_t first, std::size_t last) {
  Motions part;
  part.all.assign(motions.all.begin() + static_cast<std::ptrdiff_t>(first),
                  motions.all.begin() + static_cast<std::ptrdiff_t>(last));
  part.rotation = motions.rotation;
  part.translation = motions.translation;
  part.stride = motions.stride;
  return part;
}

}  // namespace egocal::detail
