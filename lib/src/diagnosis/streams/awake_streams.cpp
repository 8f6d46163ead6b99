// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/awake_streams.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "diagnosis/streams/step_size.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

bool moves(const Trajectory& stream, std::int64_t from_us, std::int64_t to_us,
           const AwakeStreamsOptions& options) {
  const auto earlier = [](const StampedPose& pose, std::int64_t time_us) { return pose.time_us < time_us; };
  const auto first = std::lower_bound(stream.begin(), stream.end(), from_us, earlier),
             last = std::lower_bound(first, stream.end(), to_us, earlier);
  if (std::distance(first, last) < 2) return false;
  std::vector<double> steps;
  for (auto pose = std::next(first); pose != last; ++pose)
    steps.push_back(step_size(canonical_sign(conjugate(std::prev(pose)->pose) * pose->pose)));
  const double net = step_size(canonical_sign(conjugate(first->pose) * std::prev(last)->pose));
  return net > options.least_steps * median(std::move(steps));
}

/// offset_us: from the clock of `own` to that of `other`.
Trajectory without_repeats(const Trajectory& own, const Trajectory& other, std::int64_t offset_us,
                           const AwakeStreamsOptions& options) {
  Trajectory result;
  for (std::size_t i = 0; i < own.size();) {
    const double rounding = rounding_of(own[i].pose, options.rounding);
    std::size_t end = i + 1;
    while (end < own.size() && step_size(canonical_sign(conjugate(own[i].pose) * own[end].pose)) < rounding)
      ++end;
    const bool frozen = end - i > options.least &&
                        moves(other, own[i].time_us + offset_us, own[end - 1].time_us + offset_us, options);
    const auto begin = own.begin() + static_cast<std::ptrdiff_t>(i);
    result.insert(result.end(), begin,
                  frozen ? std::next(begin) : own.begin() + static_cast<std::ptrdiff_t>(end));
    i = end;
  }
  return result;
}

}  // namespace

AwakeStreams without_frozen_poses(const Trajectory& a, const Trajectory& b, double time_offset,
                                  const AwakeStreamsOptions& options) {
  const std::int64_t offset_us = to_microseconds(time_offset);
  return {without_repeats(a, b, -offset_us, options), without_repeats(b, a, offset_us, options)};
}

}  // namespace egocal::detail
