// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/offset_fits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/geometry/pose.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/motions/instant.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/offset/pose_at.hpp"
#include "pairing/offset/turning.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t comparison_cost = 8;  ///< of a motion's four poses, in poses looked at

/// Motion from one time to another on the clock of the stream, relative to at_us [us]; empty: not known.
std::optional<DualQuaternion> motion_at(const Trajectory& poses, std::int64_t at_us, double from, double to,
                                        double max_gap_us, const SynchroniserOptions& options = {}) {
  std::size_t before = first_before(poses, at_us, from);
  const auto first = pose_at(poses, at_us, from, max_gap_us, before, options);
  if (!first) return std::nullopt;
  before = first_before(poses, at_us, to);
  const auto last = pose_at(poses, at_us, to, max_gap_us, before, options);
  if (!last) return std::nullopt;
  return motion_between(*first, *last);
}

/// Whether the gains of the parts of a drive have a positive mean.
OffsetFits::Comparison student(const std::vector<double>& gains) {
  const auto n = static_cast<double>(gains.size());
  double sum = 0, squares = 0;
  for (const double gain : gains) sum += gain;
  OffsetFits::Comparison result;
  result.gain = sum / n;
  for (const double gain : gains) squares += (gain - result.gain) * (gain - result.gain);
  if (!(squares > 0)) return result;
  result.sigmas = result.gain / std::sqrt(squares / (n - 1) / n);
  const double one_side = 0.5 * f_exceeded(result.sigmas * result.sigmas, 1, n - 1);
  result.chance = result.gain > 0 ? one_side : 1 - one_side;
  return result;
}

}  // namespace

OffsetFits::OffsetFits(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options,
                       std::int64_t max_gap_us, Schedule& schedule, const OffsetFitOptions& tuning)
    : a_(a),
      b_(b),
      options_(options),
      tuning_(tuning),
      max_gap_us_(static_cast<double>(max_gap_us)),
      schedule_(schedule),
      period_us_(static_cast<double>(std::max(median_period_us(a), median_period_us(b)))),
      length_us_(std::max(options.motion * second_us, period_us_)) {
  const double whole_us =
      static_cast<double>(b_.back().time_us - b_.front().time_us) - length_us_ - period_us_;
  spacing_us_ =
      std::max(options_.key_spacing * second_us, whole_us / static_cast<double>(options_.candidate_motions));
  count_ = whole_us > 0 ? static_cast<std::size_t>(whole_us / spacing_us_) : 0;
  floor_ = {options_.angle_floor * options_.angle_floor, options_.length_floor * options_.length_floor, true};
  for (const Trajectory* poses : {&a_, &b_})
    schedule_.add(count_ * comparison_cost / tuning_.coarse_each, [this, poses] { find_floor(*poses); });
}

void OffsetFits::add(const ClockLine& clock, const DualQuaternion& start) {
  schedule_.add(1, [this, clock, start] {
    sampled_.assign(count_, {});
    schedule_.add_range(
        count_, [this, clock](std::size_t begin, std::size_t end) { sample(clock, begin, end); },
        comparison_cost);
    schedule_.add(1, [this, start] {
      left_.assign(count_, {});
      extrinsic_ = start;
    });
    for (int round = 0; round < tuning_.rounds; ++round) schedule_.add(count_, [this] { fit(); });
    schedule_.add(count_ / 4, [this] {
      set_left();
      fits_.push_back({std::move(left_), to_pose(extrinsic_).translation.squaredNorm()});
    });
  });
}

/// Begin of a motion, since the begin of its stream.
double OffsetFits::time_us(std::size_t k) const {
  constexpr double golden = 0.6180339887498949;  // its multiples are the most even fractions (mathematics)
  const double part = golden * static_cast<double>(k);
  return static_cast<double>(k) * spacing_us_ + (part - std::floor(part)) * period_us_;
}

void OffsetFits::find_floor(const Trajectory& poses) {
  SynchroniserOptions coarse;
  coarse.smooth_poses = tuning_.coarse_poses;
  std::vector<double> rotations, translations;
  for (std::size_t k = 0; k < count_; k += tuning_.coarse_each) {
    const double from = time_us(k), to = from + length_us_;
    const auto motion = motion_at(poses, poses.front().time_us, from, to, max_gap_us_),
               other = motion_at(poses, poses.front().time_us, from, to, max_gap_us_, coarse);
    if (!motion || !other) continue;
    const Vector8d d = motion->vec() - other->vec();
    rotations.push_back(d.head<4>().squaredNorm());
    translations.push_back(d.tail<4>().squaredNorm());
  }
  floor_.rotation += median(std::move(rotations));
  floor_.translation += median(std::move(translations));
}

void OffsetFits::sample(const ClockLine& clock, std::size_t begin, std::size_t end) {
  const auto on_a = [&](double time) { return (1 + clock.rate) * time + clock.shift_us; };
  for (std::size_t k = begin; k < end; ++k) {
    const double from = static_cast<double>(b_.front().time_us - clock.at_b_us) + time_us(k),
                 to = from + length_us_;
    const auto of_a = motion_at(a_, clock.at_a_us, on_a(from), on_a(to), max_gap_us_);
    if (!of_a) continue;
    if (const auto of_b = motion_at(b_, clock.at_b_us, from, to, max_gap_us_))
      sampled_[k] = {{*of_a, *of_b}, true};
  }
}

/// What the extrinsic leaves of each motion (18).
void OffsetFits::set_left() {
  for (std::size_t k = 0; k < count_; ++k) {
    if (!sampled_[k].known) continue;
    const MotionPair& pair = sampled_[k].motion;
    const Vector8d d = (pair.a * extrinsic_).vec() - (extrinsic_ * pair.b).vec();
    left_[k] = {d.head<4>().squaredNorm(), d.tail<4>().squaredNorm(), true};
  }
}

/// One weighted global solution of (18), with the weights of the extrinsic before.
void OffsetFits::fit() {
  set_left();
  std::vector<double> rotations, translations;
  rotations.reserve(count_);
  translations.reserve(count_);
  for (std::size_t k = 0; k < count_; ++k) {
    if (!sampled_[k].known) continue;
    rotations.push_back(left_[k].rotation);
    translations.push_back(left_[k].translation);
  }
  if (rotations.empty()) return;
  const double rotation = median(std::move(rotations)) + floor_.rotation,
               translation = median(std::move(translations)) + floor_.translation;
  Statistics statistics;
  for (std::size_t k = 0; k < count_; ++k) {
    if (!sampled_[k].known) continue;
    const double root =
        1 / (1 + (left_[k].rotation / rotation + left_[k].translation / translation) / options_.outlier);
    statistics.add(sampled_[k].motion.a, sampled_[k].motion.b, root * root);
  }
  extrinsic_ = solve_dual(cost_matrix(statistics, Balance{1, options_.translation_weight})).q;
}

std::optional<OffsetFits::Comparison> OffsetFits::compare(std::size_t first, std::size_t second) const {
  const std::vector<Left>&one = fits_[first].left, &other = fits_[second].left;
  std::vector<std::size_t> common;
  for (std::size_t k = 0; k < count_; ++k)
    if (one[k].known && other[k].known) common.push_back(k);
  // motions that overlap share poses
  const auto independent =
      static_cast<std::size_t>(static_cast<double>(common.size()) * std::min(1.0, spacing_us_ / length_us_));
  const std::size_t parts = std::min(tuning_.parts, independent);
  if (parts < tuning_.least_parts) return std::nullopt;
  // below the noise of the better one there is nothing to win
  const auto noise = [&](double Left::*square) {
    std::vector<double> of_one, of_other;
    for (const std::size_t k : common) {
      of_one.push_back(one[k].*square);
      of_other.push_back(other[k].*square);
    }
    return std::min(median(std::move(of_one)), median(std::move(of_other))) + floor_.*square;
  };
  const double rotation = noise(&Left::rotation), translation = noise(&Left::translation);
  // The noise of the rotations of a moves the end of the lever arm: a longer arm leaves larger residuals
  // without being worse. By how much depends on whose noise it is, so the first clock must be worse both
  // without this effect and with all of it.
  Comparison least;
  for (const double share : {0.0, 1.0}) {
    const auto loss = [&](const Fit& fit, std::size_t k) {
      return std::log(1 + fit.left[k].rotation / rotation +
                      fit.left[k].translation / (translation + share * fit.square_lever * rotation));
    };
    std::vector<double> gains(parts, 0.0);
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t begin = part * common.size() / parts, end = (part + 1) * common.size() / parts;
      for (std::size_t i = begin; i < end; ++i)
        gains[part] += loss(fits_[first], common[i]) - loss(fits_[second], common[i]);
      gains[part] /= static_cast<double>(end - begin);
    }
    const Comparison here = student(gains);
    if (share == 0 || here.chance > least.chance) least = here;
  }
  return least;
}

}  // namespace egocal::detail
