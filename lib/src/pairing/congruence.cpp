// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/congruence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "statistics/order_statistic.hpp"

namespace egocal {

namespace {

using Seen = TypicalDifference::Seen;

/// Standard deviation of a normal distribution over the lower quartile and over the median of its absolute
/// values (mathematics, no tuning).
constexpr double deviations_per_quartile = 3.1386, deviations_per_median = 1.4826;
/// Robust standard deviation of absolute values. It starts from the lower quartile: if a fifth of the poses
/// is wrong, more than a third of the motions are, and nearly two thirds of interpolated ones. Then it takes
/// the median of the near values. before: the last result, to find this one faster.
double robust_deviation(std::span<const double> values, double before,
                        const detail::ExpectedOptions& expected = {}) {
  const double lower = expected.lower, upper = expected.upper;
  const detail::Expected quartile{lower * before / deviations_per_quartile,
                                  upper * before / deviations_per_quartile};
  double deviation = deviations_per_quartile * detail::order_statistic(values, values.size() / 4, quartile);
  for (std::size_t i = 0, last = 0; i < 3; ++i) {
    std::size_t near = 0;
    for (const double value : values) near += static_cast<unsigned>(value <= 4 * deviation);
    if (near == last) break;  // the same values, and the same median
    last = near;
    const detail::Expected median{lower * deviation / deviations_per_median,
                                  upper * deviation / deviations_per_median};
    deviation = deviations_per_median * detail::order_statistic(values, near / 2, median);
  }
  return deviation;
}

/// The remembered motions in the order of time: an estimate reads them many times.
struct Remembered {
  std::vector<double> sizes, differences;

  explicit Remembered(const std::deque<Seen>& newest) {
    sizes.reserve(newest.size());
    differences.reserve(newest.size());
    for (const Seen& one : newest) {
      sizes.push_back(one.size);
      differences.push_back(one.difference);
    }
  }

  /// Omits motions smaller than `least`.
  void leave_out_smaller(double least) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sizes.size();
         ++i) {  // without a branch that the processor could guess wrongly
      const double size = sizes[count] = sizes[i];
      differences[count] = differences[i];
      count += size >= least ? 1 : 0;
    }
    sizes.resize(count);
    differences.resize(count);
  }
};

/// The smaller half of the motions and the larger one, each in the order of time.
struct Halves {
  std::vector<double> small, large;  ///< differences
  std::vector<double> large_sizes;

  /// Uses motions of at least `least`, if enough are smaller to reach the lower quartile of the smaller half:
  /// an eighth of all. least: at most moving_size() of these motions, so that some are left.
  Halves(Remembered all, double least) {
    const std::vector<double>&sizes = all.sizes, &differences = all.differences;
    std::size_t standing = 0;
    for (const double size : sizes) standing += size < least ? 1 : 0;
    if (8 * standing >= sizes.size()) all.leave_out_smaller(least);
    const std::size_t count = sizes.size(), half = count / 2;
    const double least_large = detail::order_statistic(sizes, half);
    std::size_t below = 0;
    for (const double size : sizes) below += size < least_large ? 1 : 0;
    std::size_t equal_small = half - below;  // of equal ones the oldest are the small ones
    small.resize(count);
    large.resize(count);
    large_sizes.resize(count);
    std::size_t smalls = 0, larges = 0;
    for (std::size_t i = 0; i < count; ++i) {  // without a branch that the processor could guess wrongly
      const unsigned is_equal = sizes[i] == least_large ? 1 : 0;
      const unsigned equal_and_small = is_equal & (equal_small > 0 ? 1U : 0U);
      const unsigned is_small = (sizes[i] < least_large ? 1U : 0U) | equal_and_small;
      equal_small -= equal_and_small;
      small[smalls] = large[larges] = differences[i];
      large_sizes[larges] = sizes[i];
      smalls += is_small;
      larges += 1 - is_small;
    }
    small.resize(smalls);
    large.resize(larges);
    large_sizes.resize(larges);
  }
};

/// The size that a moving vehicle exceeds in at least half of its motions, or in enough for an estimate.
double moving_size(const Remembered& all, const CongruenceOptions& options) {
  if (all.sizes.empty()) return 0;
  const std::size_t larger = std::min(options.first_estimate, (all.sizes.size() + 1) / 2);
  return detail::order_statistic(all.sizes, all.sizes.size() - larger);
}

/// The smaller half shows the noise without motion, the larger half the noise that grows with it.
void estimate(TypicalDifference& typical, const CongruenceOptions& options) {
  if (typical.newest.size() < 4) return;
  Remembered all(typical.newest);
  typical.moving = moving_size(all, options);
  const Halves halves(std::move(all), options.still * typical.moving);
  const double before_small = typical.constant,
               before_large = typical.constant + typical.growing * typical.large;
  typical.large = 0;
  for (const double size : halves.large_sizes)
    typical.large += size / static_cast<double>(halves.large_sizes.size());
  typical.constant = robust_deviation(halves.small, before_small);
  typical.growing =
      typical.large > 0
          ? std::clamp((robust_deviation(halves.large, before_large) - typical.constant) / typical.large, 0.0,
                       options.most_growing)
          : 0;
}

/// Lever arm from the motions that turn more than others: three times the median covers the directions
/// between the axes.
double arm_of(const TypicalDifference& lever, const CongruenceOptions& options) {
  if (lever.newest.empty()) return 0;
  Remembered all(lever.newest);
  const double least = options.still * moving_size(all, options);
  const Halves halves(std::move(all), least);
  std::vector<double> arms;
  arms.reserve(halves.large.size());
  for (std::size_t i = 0; i < halves.large.size(); ++i)
    if (halves.large_sizes[i] > 0) arms.push_back(halves.large[i] / halves.large_sizes[i]);
  if (arms.empty()) return 0;
  return std::min(options.longest_lever_arm, 3 * detail::order_statistic(arms, arms.size() / 2));
}

void remember(const Seen& seen, TypicalDifference& typical, const CongruenceOptions& options) {
  typical.newest.push_back(seen);
  if (typical.newest.size() > options.memory) typical.newest.pop_front();
}

void remember(const MotionDifference& d, CongruenceScale& scale, const CongruenceOptions& options) {
  remember(d.angle, scale.angle, options);
  if (d.turns) remember(d.slide, scale.slide, options);
  remember(d.length, scale.length, options);
  remember({d.angle.size, d.length.difference}, scale.lever, options);
  ++scale.remembered;
}

bool estimate_is_due(std::uint64_t remembered, const CongruenceOptions& options) {
  const std::uint64_t every =
      remembered > options.memory ? options.estimate_every_when_full : options.estimate_every;
  return remembered == options.first_estimate ||
         (remembered > options.first_estimate && remembered % every == 0);
}

void estimate(CongruenceScale& scale, const CongruenceOptions& options) {
  for (TypicalDifference* typical : {&scale.angle, &scale.slide, &scale.length}) estimate(*typical, options);
  scale.arm = arm_of(scale.lever, options);
}

/// Whether the vehicle stood at one of two times, by the sizes of its motions then.
bool stood_or_stands(double before, double now, const CongruenceOptions& options) {
  return std::min(before, now) < options.still * std::max(before, now);
}

/// Updates one of the four estimates in turn: with a full memory they change slowly, and no single pose takes
/// the time of all. Updates all of them when the vehicle has parked for as long as the memory reaches, or
/// drives again: a mixture of estimates would reject the drive.
void estimate_next(CongruenceScale& scale, const CongruenceOptions& options) {
  TypicalDifference* const in_turn[] = {&scale.angle, &scale.slide, &scale.length};
  const std::uint64_t turn = scale.remembered / options.estimate_every_when_full % 4;
  if (turn == 3) {
    scale.arm = arm_of(scale.lever, options);
    return;
  }
  const double before = in_turn[turn]->moving;
  estimate(*in_turn[turn], options);
  if (stood_or_stands(before, in_turn[turn]->moving, options)) estimate(scale, options);
}

/// floor: what rounding alone makes of it. Where both streams are rounded alike most differences are zero,
/// and the estimate says nothing about the others. more: that is added.
double sigmas(const Seen& seen, const TypicalDifference& typical, double floor,
              const CongruenceOptions& options, double more = 0) {
  if (typical.newest.size() < options.first_estimate) return 0;
  return seen.difference / (std::max(typical.constant, floor) + typical.growing * seen.size + more);
}

/// Whether it turns far more than the larger motions seen: the first turn in place after a straight road.
bool turns_unlike_those_seen(const MotionDifference& d, double steps, const CongruenceScale& scale,
                             const CongruenceOptions& options) {
  return d.angle.size > options.turns_more * steps * scale.angle.large;
}

/// Nor is it known how the noise of such a turn grows.
double sigmas_of_angle(const MotionDifference& d, double steps, const CongruenceScale& scale,
                       const CongruenceOptions& options) {
  const bool unlike = turns_unlike_those_seen(d, steps, scale, options);
  return sigmas(d.angle, scale.angle, options.angle_floor, options,
                unlike ? options.noise_of_turns * d.angle.size : 0);
}

/// Rounding turns the axis along which a motion slides, the more the less it turns.
double sigmas_of_slide(const MotionDifference& d, const CongruenceScale& scale,
                       const CongruenceOptions& options) {
  if (!d.turns) return 0;
  const double floor = options.length_floor + options.angle_floor / d.angle.size * d.slide.size;
  return sigmas(d.slide, scale.slide, floor, options);
}

/// A straight road shows the lever arm along the road only; another kind of turn may show all of it.
double unexplained_length(const MotionDifference& d, double steps, const CongruenceScale& scale,
                          const CongruenceOptions& options) {
  const bool unlike = turns_unlike_those_seen(d, steps, scale, options);
  const double arm = unlike ? options.longest_lever_arm : scale.arm;
  return std::max(0.0, d.length.difference - arm * d.angle.size);
}

/// Whether these are the first motions after the vehicle stood: earlier motions say nothing about them.
bool longer_than_all_seen(const MotionDifference& d, double steps, const CongruenceScale& scale,
                          const CongruenceOptions& options) {
  return d.length.size > options.beyond * steps * std::max(scale.length.moving, options.length_floor);
}
/// Angles also change this much between a straight road and a turn, so they count only if nothing moved.
bool turns_more_than_all_seen(const MotionDifference& d, double steps, const CongruenceScale& scale,
                              const CongruenceOptions& options) {
  return scale.length.moving <= options.length_floor &&
         d.angle.size > options.beyond * steps * std::max(scale.angle.moving, options.angle_floor);
}

}  // namespace

MotionDifference difference_of(const DualQuaternion& a, const DualQuaternion& b,
                               const CongruenceOptions& options) {
  const Screw screw_a = screw_of(a), screw_b = screw_of(b);
  const double angle = std::min(screw_a.angle, screw_b.angle);
  const double length_a = translation_length(a), length_b = translation_length(b),
               length = std::min(length_a, length_b);
  return {{angle, std::abs(screw_a.angle - screw_b.angle)},
          {length, std::abs(screw_a.slide - screw_b.slide)},
          {length, std::abs(length_a - length_b)},
          angle > options.least_turn};
}

bool knows_typical(const CongruenceScale& scale, const CongruenceOptions& options) {
  return scale.remembered >= options.first_estimate;
}

double incongruence(const MotionDifference& d, double steps, const CongruenceScale& scale,
                    const CongruenceOptions& options) {
  if (!knows_typical(scale, options)) return 0;
  const double unexplained = unexplained_length(d, steps, scale, options);
  const bool longer = longer_than_all_seen(d, steps, scale, options);
  if (longer || turns_more_than_all_seen(d, steps, scale, options)) {
    if (d.angle.difference > options.gross_angle) return std::numeric_limits<double>::infinity();
    return longer ? unexplained / (options.unknown_noise * d.length.size) : 0;
  }
  return std::max({sigmas_of_angle(d, steps, scale, options), sigmas_of_slide(d, scale, options),
                   sigmas({d.length.size, unexplained}, scale.length, options.length_floor, options)});
}

bool grossly_incongruent(const MotionDifference& d, double steps, const CongruenceScale& scale,
                         const CongruenceOptions& options) {
  return d.angle.difference > options.gross_angle ||
         unexplained_length(d, steps, scale, options) > options.gross_lengths * steps * scale.length.large;
}

void update_congruence(const MotionDifference& d, bool doubtful, CongruenceScale& scale,
                       const CongruenceOptions& options) {
  if (doubtful && ++scale.doubtful % options.doubtful_remembered != 0) return;
  remember(d, scale, options);
  if (!estimate_is_due(scale.remembered, options)) return;
  if (scale.remembered > options.memory)
    estimate_next(scale, options);
  else
    estimate(scale, options);
}

std::vector<bool> incongruent(std::span<const MotionPair> pairs, const ScreeningOptions& screening) {
  const CongruenceOptions& options = screening.congruence;
  std::vector<bool> result;
  while (!pairs.empty()) {
    // the last ones are compared with those before them
    const std::size_t count = pairs.size() < 2 * options.memory ? pairs.size() : options.memory;
    CongruenceScale scale;
    std::uint64_t last_estimate = count;
    while (last_estimate > 0 && !estimate_is_due(last_estimate, options)) --last_estimate;
    std::vector<MotionDifference> differences;
    differences.reserve(count);
    for (const MotionPair& pair : pairs.first(count)) {
      differences.push_back(difference_of(pair.a, pair.b, options));
      remember(differences.back(), scale, options);
      if (scale.remembered == last_estimate) estimate(scale, options);
    }
    for (const MotionDifference& difference : differences)
      result.push_back(incongruence(difference, 1, scale, options) > screening.doubtful);
    pairs = pairs.subspan(count);
  }
  return result;
}

}  // namespace egocal
