// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal/goal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "diagnosis/goal/goal_spread.hpp"
#include "diagnosis/goal/manoeuvres.hpp"
#include "egocal/directions.hpp"
#include "egocal/uncertainty/plane_directions.hpp"

namespace egocal {

namespace detail {

bool expected(const Answered& answered, std::size_t direction) {
  return answered.problem.mode != Mode::planar || in_plane(answered.problem.plane_a, direction);
}

namespace {

/// How probable it is that a direction is within `interval` goals, where its errors are normal. ratio: its
/// standard deviation over the goal.
double chance_within(double ratio, double interval) {
  return std::erf(interval / (ratio * std::numbers::sqrt2));
}

/// Factor by which all standard deviations have to fall until all directions are within the goal with the
/// probability of `tuning`. ratios: standard deviations over the goal, finite, above 0.
double excess_of(const std::vector<double>& ratios, const GoalSpreadOptions& tuning) {
  const auto enough = [&](double factor) {
    double chance = 1;
    for (const double ratio : ratios) chance *= chance_within(ratio / factor, tuning.interval);
    return chance >= tuning.probability;
  };
  double low = 0, high = *std::max_element(ratios.begin(), ratios.end());
  while (!enough(high)) high *= 2;
  for (int i = 0; i < 60; ++i) {  // to the last bit
    const double middle = 0.5 * (low + high);
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

/// Time left over that of the drive from what it would be if all information grew steadily.
double likely_time_left(double steady, const GoalSpreadOptions& tuning) {
  const double left = std::hypot(steady, tuning.least_time_left);
  return left > 1 ? std::pow(left, tuning.power_of_long_times) : left;
}

}  // namespace

double with_further_parts(double stddev, const Answered& answered, std::size_t direction) {
  return std::hypot(std::hypot(stddev, answered.scale_stddev[direction]), answered.timing_stddev[direction]);
}

Goal goal_of(const Answered& answered, const GoalOptions& options, const GoalSpreadOptions& tuning) {
  const std::array<double, 6> spread = goal_spread(answered, tuning);
  std::vector<std::pair<double, std::size_t>> missing;
  std::vector<double> ratios;
  double chance = 1;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!expected(answered, i)) continue;
    const double wanted = i < 3 ? options.translation : options.rotation;
    const double stddev =
        answered.observability.observable[i] ? with_further_parts(spread[i], answered, i) : INFINITY;
    const double ratio = stddev >= 0 && wanted > 0 ? stddev / wanted : INFINITY;
    missing.emplace_back(ratio, i);
    ratios.push_back(ratio);
    chance *= chance_within(ratio, tuning.interval);
  }
  // of directions that are all as probable as this, the goal would be reached
  const double each = std::pow(tuning.probability, 1.0 / static_cast<double>(ratios.size()));
  std::erase_if(missing, [&](const auto& x) { return chance_within(x.first, tuning.interval) >= each; });
  Goal goal;
  goal.reached = chance >= tuning.probability || missing.empty();
  if (goal.reached) return goal;
  std::sort(missing.begin(), missing.end(), [](const auto& x, const auto& y) {
    return x.first > y.first || (x.first == y.first && x.second < y.second);
  });
  for (const auto& [ratio, i] : missing) goal.missing.emplace_back(direction_names[i]);
  if (const double worst = missing.front().first; std::isfinite(worst)) {
    const double excess = excess_of(ratios, tuning);
    for (auto& [ratio, i] : missing) ratio *= excess / worst;  // the worst one is known well enough at 1
    if (answered.seconds > 0)
      goal.seconds_left =
          answered.seconds * likely_time_left(std::pow(excess, 1 / tuning.exponent) - 1, tuning);
  }
  goal.next = next_manoeuvre(answered, options, missing, tuning.exponent);
  return goal;
}

}  // namespace detail

}  // namespace egocal
