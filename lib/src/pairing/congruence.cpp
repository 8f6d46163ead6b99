// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/congruence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace egocal {

namespace {

using Seen = TypicalDifference::Seen;

/// Below this angle a motion has no axis to slide along [rad].
constexpr double least_turn = 0.02;
/// Differences that mean nothing: rounding of what sensors send [rad, m].
constexpr double angle_floor = 1e-6, length_floor = 1e-5;
/// Memory, in motions, and how many of them make a first and every further estimate.
constexpr std::size_t memory = 1024, first_estimate = 24;
/// Motions between estimates, until the memory is full and from then on: one sixteenth of it is new
/// (measured: the same answers, a third of the time).
constexpr std::uint64_t estimate_every = 16, estimate_every_when_full = 64;
constexpr std::uint64_t doubted_that_teach = 8;
/// Odometry whose noise were a larger part of the motion would not be any.
constexpr double most_growing = 0.2;
/// Noise of no odometry is as large as that from one pose to the next: an angle [rad], and lengths as a
/// multiple of the longer half of the motions.
constexpr double gross_angle = 20 * std::numbers::pi / 180, gross_lengths = 10;

struct Difference {
  Seen angle, slide, length;
  bool turns;
};

double translation_of(const DualQuaternion& motion) {
  return 2 * motion.dual.norm();
}

Difference difference(const DualQuaternion& a, const DualQuaternion& b) {
  const Screw screw_a = screw_of(a), screw_b = screw_of(b);
  const double angle = std::min(screw_a.angle, screw_b.angle);
  const double length_a = translation_of(a), length_b = translation_of(b),
               length = std::min(length_a, length_b);
  return {{angle, std::abs(screw_a.angle - screw_b.angle)},
          {length, std::abs(screw_a.slide - screw_b.slide)},
          {length, std::abs(length_a - length_b)},
          angle > least_turn};
}

/// Of a normal distribution: its standard deviation by the lower quartile and by the median of absolute
/// values.
constexpr double deviations_per_quartile = 3.1386, deviations_per_median = 1.4826;

/// Standard deviation of most of the values (absolute ones). A lower quartile to begin with, for with a fifth
/// of the poses wrong more than a third of the motions are, and if interpolated nearly two thirds; then the
/// median of what is near.
double robust_deviation(std::vector<double> values) {
  const auto at = [&values](std::size_t count, std::size_t place) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place),
                     values.begin() + static_cast<std::ptrdiff_t>(count));
    return values[place];
  };
  double deviation = deviations_per_quartile * at(values.size(), values.size() / 4);
  for (int i = 0; i < 3; ++i) {
    // the same order statistics as of sorted values, in linear time
    const auto end = std::partition(values.begin(), values.end(),
                                    [limit = 4 * deviation](double value) { return value <= limit; });
    const auto near = static_cast<std::size_t>(end - values.begin());
    deviation = deviations_per_median * at(near, near / 2);
  }
  return deviation;
}

/// The smaller half of the motions, then the larger.
std::pair<std::vector<Seen>, std::vector<Seen>> halves(const std::deque<Seen>& newest) {
  std::vector<Seen> small(newest.begin(), newest.end());
  const auto half = small.begin() + static_cast<std::ptrdiff_t>(small.size() / 2);
  std::nth_element(small.begin(), half, small.end(),
                   [](const Seen& x, const Seen& y) { return x.size < y.size; });
  std::vector<Seen> large(half, small.end());
  small.erase(half, small.end());
  return {std::move(small), std::move(large)};
}

double robust_deviation(const std::vector<Seen>& seen) {
  std::vector<double> differences;
  differences.reserve(seen.size());
  for (const Seen& one : seen) differences.push_back(one.difference);
  return robust_deviation(std::move(differences));
}

/// The smaller half shows what there is without motion, the larger half what grows with it.
void estimate(TypicalDifference& typical) {
  if (typical.newest.size() < 4) return;
  const auto [small, large] = halves(typical.newest);
  typical.large = 0;
  for (const Seen& one : large) typical.large += one.size / static_cast<double>(large.size());
  typical.constant = robust_deviation(small);
  typical.growing =
      typical.large > 0
          ? std::clamp((robust_deviation(large) - typical.constant) / typical.large, 0.0, most_growing)
          : 0;
}

/// From the motions that turn more than others: three times the median covers the directions in between.
double arm_of(const TypicalDifference& lever, double longest) {
  std::vector<double> arms;
  for (const Seen& one : halves(lever.newest).second)
    if (one.size > 0) arms.push_back(one.difference / one.size);
  if (arms.empty()) return 0;
  std::nth_element(arms.begin(), arms.begin() + static_cast<std::ptrdiff_t>(arms.size() / 2), arms.end());
  return std::min(longest, 3 * arms[arms.size() / 2]);
}

void remember(const Seen& seen, TypicalDifference& typical) {
  typical.newest.push_back(seen);
  if (typical.newest.size() > memory) typical.newest.pop_front();
}

void remember(const DualQuaternion& a, const DualQuaternion& b, CongruenceScale& scale) {
  const Difference d = difference(a, b);
  remember(d.angle, scale.angle);
  if (d.turns) remember(d.slide, scale.slide);
  remember(d.length, scale.length);
  remember({d.angle.size, d.length.difference}, scale.lever);
  ++scale.taught;
}

bool estimate_is_due(std::uint64_t taught) {
  const std::uint64_t every = taught > memory ? estimate_every_when_full : estimate_every;
  return taught == first_estimate || (taught > first_estimate && taught % every == 0);
}

void estimate(CongruenceScale& scale, double longest_lever_arm) {
  for (TypicalDifference* typical : {&scale.angle, &scale.slide, &scale.length}) estimate(*typical);
  scale.arm = arm_of(scale.lever, longest_lever_arm);
}

double sigmas(const Seen& seen, const TypicalDifference& typical, double floor) {
  if (typical.newest.size() < first_estimate) return 0;
  return seen.difference / (typical.constant + typical.growing * seen.size + floor);
}

double unexplained_length(const Difference& d, const CongruenceScale& scale) {
  return std::max(0.0, d.length.difference - scale.arm * d.angle.size);
}

}  // namespace

bool knows_typical(const CongruenceScale& scale) {
  return scale.taught >= first_estimate;
}

double incongruence(const DualQuaternion& a, const DualQuaternion& b, const CongruenceScale& scale) {
  if (!knows_typical(scale)) return 0;
  const Difference d = difference(a, b);
  const double unexplained = unexplained_length(d, scale);
  return std::max({sigmas(d.angle, scale.angle, angle_floor),
                   d.turns ? sigmas(d.slide, scale.slide, length_floor) : 0,
                   sigmas({d.length.size, unexplained}, scale.length, length_floor)});
}

bool grossly_incongruent(const DualQuaternion& a, const DualQuaternion& b, double steps,
                         const CongruenceScale& scale) {
  const Difference d = difference(a, b);
  return d.angle.difference > gross_angle ||
         unexplained_length(d, scale) > gross_lengths * steps * scale.length.large;
}

void update_congruence(const DualQuaternion& a, const DualQuaternion& b, bool doubted, CongruenceScale& scale,
                       double longest_lever_arm) {
  if (doubted && ++scale.doubted % doubted_that_teach != 0) return;
  remember(a, b, scale);
  if (estimate_is_due(scale.taught)) estimate(scale, longest_lever_arm);
}

std::vector<bool> incongruent(std::span<const MotionPair> pairs, const ScreeningOptions& options) {
  std::vector<bool> verdicts;
  while (!pairs.empty()) {
    // the last ones are judged with those before them
    const std::size_t count = pairs.size() < 2 * memory ? pairs.size() : memory;
    CongruenceScale scale;
    std::uint64_t last_estimate = count;
    while (last_estimate > 0 && !estimate_is_due(last_estimate)) --last_estimate;
    for (const MotionPair& pair : pairs.first(count)) {
      remember(pair.a, pair.b, scale);
      if (scale.taught == last_estimate) estimate(scale, options.longest_lever_arm);
    }
    for (const MotionPair& pair : pairs.first(count))
      verdicts.push_back(incongruence(pair.a, pair.b, scale) > options.doubtful);
    pairs = pairs.subspan(count);
  }
  return verdicts;
}

}  // namespace egocal
