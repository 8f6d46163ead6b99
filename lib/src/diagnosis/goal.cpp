// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "diagnosis/goal_spread.hpp"
#include "diagnosis/manoeuvres.hpp"

namespace egocal {

namespace detail {

bool expected(const Answered& answered, std::size_t direction) {
  if (answered.problem.mode != Mode::planar) return true;
  const double normal = std::abs(answered.problem.plane_a.normal[static_cast<int>(direction % 3)]);
  return direction < 3 ? normal < 0.5 : normal > 0.5;
}

Goal goal_of(const Answered& answered, const GoalOptions& options, const GoalSpreadOptions& tuning) {
  constexpr const char* directions[] = {"x", "y", "z", "roll", "pitch", "yaw"};
  const std::array<double, 6> spread = goal_spread(answered, tuning);
  std::vector<std::pair<double, std::size_t>> missing;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!expected(answered, i)) continue;
    const double wanted = i < 3 ? options.translation : options.rotation;
    const double stddev =
        answered.observability.observable[i] ? std::hypot(spread[i], answered.scale_stddev[i]) : INFINITY;
    if (!(stddev <= wanted)) missing.emplace_back(stddev / wanted, i);
  }
  std::sort(missing.begin(), missing.end(), [](const auto& x, const auto& y) {
    return x.first > y.first || (x.first == y.first && x.second < y.second);
  });
  Goal goal;
  goal.reached = missing.empty();
  if (goal.reached) return goal;
  for (const auto& [ratio, i] : missing) goal.missing.emplace_back(directions[i]);
  const double worst = missing.front().first;
  if (std::isfinite(worst) && answered.seconds > 0)
    goal.seconds_left = answered.seconds * (std::pow(worst, 1 / tuning.exponent) - 1);
  goal.next = next_manoeuvre(answered, options, missing, goal.seconds_left, tuning.exponent);
  return goal;
}

}  // namespace detail

}  // namespace egocal
