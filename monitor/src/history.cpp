// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace egocal::monitor {
namespace {
constexpr double finest_s = 0.1;  // [s]
double width_of_level(std::size_t level) {
  return finest_s * std::pow(8.0, static_cast<double>(level));
}
}  // namespace

void History::add(double time, const std::array<double, curve_count>& values) {
  if (!std::isfinite(time)) return;
  if (empty()) {
    first_ = time;
  } else if (time < last_) {
    return;
  }
  last_ = time;
  for (std::size_t level = 0; level < levels; ++level) {
    std::deque<Slice>& course = levels_[level];
    const double begin = std::floor(time / width_of_level(level)) * width_of_level(level);
    if (course.empty() || begin > course.back().begin) {
      if (course.size() == slices) course.pop_front();
      course.emplace_back().begin = begin;
      course.back().low.fill(std::numeric_limits<float>::quiet_NaN());
      course.back().high.fill(std::numeric_limits<float>::quiet_NaN());
    }
    Slice& slice = course.back();
    for (std::size_t i = 0; i < curve_count; ++i) {
      if (!std::isfinite(values[i])) continue;
      const auto value = static_cast<float>(std::clamp(values[i], -1e30, 1e30));
      slice.low[i] = std::fmin(slice.low[i], value);
      slice.high[i] = std::fmax(slice.high[i], value);
    }
  }
}

const std::deque<Slice>& History::since(double time) const {
  for (const std::deque<Slice>& course : levels_)
    if (course.size() < slices || course.front().begin <= time) return course;
  return levels_.back();
}

double History::slice_width(const std::deque<Slice>& course) const {
  return width_of_level(static_cast<std::size_t>(&course - levels_.data()));
}

}  // namespace egocal::monitor
