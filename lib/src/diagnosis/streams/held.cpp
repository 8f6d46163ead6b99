// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/held.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// The numbers of a row that are held together.
using Values = Eigen::Vector4d;

struct Step {
  double size = 0;   ///< [m or half of the angle]
  double least = 0;  ///< of the numbers that change; 0: none does
};

Values position(const DualQuaternion& pose) {
  const Eigen::Vector3d at = to_pose(pose).translation;
  return {at.x(), at.y(), at.z(), 0};
}

Values rotation(const DualQuaternion& pose) {
  return {pose.real[0], pose.real[1], pose.real[2], pose.real[3]};
}

/// either: q and -q are the same rotation.
Step step(const Values& from, const Values& to, bool either, double rounding) {
  const double sign = either && from.dot(to) < 0 ? -1 : 1;
  const Values change = sign * to - from;
  const double digits = rounding * (1 + from.norm());
  Step result;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double number = std::abs(change[i]);
    if (number > digits && (result.least == 0 || number < result.least)) result.least = number;
  }
  if (result.least > 0) result.size = change.norm();
  return result;
}

/// Median time from pose to pose, of those that are looked at [us].
double typical_step(const Trajectory& stream, std::size_t first, std::size_t count) {
  std::vector<double> steps;
  for (std::size_t i = first + 1; i < first + count; ++i)
    steps.push_back(static_cast<double>(stream[i].time_us - stream[i - 1].time_us));
  return median(std::move(steps));
}

struct Counts {
  std::size_t repeated = 0, going_on = 0, fresh = 0;  ///< rows
  double seconds = 0;                                 ///< of all steps
  double way = 0;                                     ///< of all steps
  std::vector<double> behind;                         ///< steps behind a repeated value
  std::vector<double> rows;                           ///< that each value lasts for
  double digit = std::numeric_limits<double>::infinity();
};

Counts counts_of(const Trajectory& stream, bool positions, const HeldOptions& options) {
  const auto own = positions ? position : rotation, other = positions ? rotation : position;
  const std::size_t n = stream.size(), count = std::min(n, options.most), first = (n - count) / 2;
  const double longest_us = options.gap * typical_step(stream, first, count);
  Counts counts;
  bool repeats = false;
  std::size_t since = first;
  for (std::size_t i = first + 1; i < first + count; ++i) {
    const StampedPose &from = stream[i - 1], &to = stream[i];
    if (static_cast<double>(to.time_us - from.time_us) > longest_us) {
      repeats = false;
      since = i;
      continue;
    }
    counts.seconds += to_seconds(to.time_us - from.time_us);
    const Step here = step(own(from.pose), own(to.pose), !positions, options.rounding);
    if (here.size == 0) {
      repeats = true;
      ++counts.repeated;
      counts.going_on += step(other(from.pose), other(to.pose), positions, options.rounding).size > 0 ? 1 : 0;
      continue;
    }
    ++counts.fresh;
    counts.way += here.size;
    counts.digit = std::min(counts.digit, here.least);
    if (repeats) counts.behind.push_back(here.size);
    counts.rows.push_back(static_cast<double>(i - since));
    since = i;
    repeats = false;
  }
  return counts;
}

bool repeats_so(const Counts& counts, const HeldOptions& options) {
  if (counts.behind.size() < options.least) return false;
  if (static_cast<double>(counts.going_on) < options.going_on * static_cast<double>(counts.repeated))
    return false;
  const double usual = median(counts.rows);
  const auto even = std::count_if(counts.rows.begin(), counts.rows.end(),
                                  [&](double rows) { return std::abs(rows - usual) <= 1; });
  if (static_cast<double>(even) < options.even * static_cast<double>(counts.rows.size())) return false;
  double way = 0;
  for (const double size : counts.behind) way += size;
  return way >= options.share * counts.way && median(counts.behind) >= options.digits * counts.digit;
}

}  // namespace

std::optional<Held> repeating_half(const Trajectory& stream, const HeldOptions& options) {
  if (stream.size() <= options.least) return std::nullopt;
  for (const bool positions : {true, false}) {
    const Counts counts = counts_of(stream, positions, options);
    if (!repeats_so(counts, options)) continue;
    const auto own = positions ? position : rotation;
    Held result;
    result.positions = positions;
    if (counts.seconds > 0) result.rate = static_cast<double>(counts.fresh) / counts.seconds;
    for (std::size_t i = 1; i < stream.size(); ++i) {
      if (step(own(stream[i - 1].pose), own(stream[i].pose), !positions, options.rounding).size == 0)
        continue;
      if (!result.fresh.empty() && i > result.fresh.back() + 1)
        result.repeating.push_back({result.fresh.back(), i - 1, i});
      result.fresh.push_back(i);
    }
    return result;
  }
  return std::nullopt;
}

}  // namespace egocal::detail
