// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/solve_time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "egocal/online/answer.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::tools {

namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

double median_us(const std::function<double()>& measure_us) {
  std::vector<double> times;
  const auto begin = Clock::now();
  while (times.size() < 5 || (times.size() < 201 && Clock::now() - begin < std::chrono::milliseconds(100)))
    times.push_back(measure_us());
  return detail::median(std::move(times));
}

double time_of_method(Method method, const Problem& problem) {
  const NanosecondClock clock = [] {
    return static_cast<std::int64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count());
  };
  return median_us(
      [&] { return 1e-3 * static_cast<double>(solve(problem, method, std::nullopt, clock).solve_ns); });
}

}  // namespace egocal::tools
