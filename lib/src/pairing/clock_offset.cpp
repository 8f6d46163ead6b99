// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/clock_offset.hpp"

#include <algorithm>
#include <cmath>

namespace egocal {

namespace {

constexpr std::int64_t second_us = 1'000'000;
/// Estimates are made after so long, then after so long again [us].
constexpr std::int64_t first_us = 10 * second_us, every_us = 30 * second_us;
/// Length of the streams that an estimate looks at, and how far one may run ahead of the other [us].
constexpr std::int64_t window_us = 60 * second_us, longest_us = 180 * second_us;
constexpr double least_correlation = 0.7, largest_stddev = 0.005;
constexpr double least_change = 0.005, change_sigmas = 4;

bool good(const TimeOffset& offset) {
  return offset.correlation >= least_correlation && offset.stddev <= largest_stddev;
}

StampedPose shifted(StampedPose pose, Side side, double offset) {
  if (side == Side::b) pose.time_us += std::llround(offset * 1e6);
  return pose;
}

/// The minute of a stream before `until` of its own time.
Trajectory part(const ClockState::Stream& stream, std::int64_t until) {
  Trajectory result;
  for (const StampedPose& pose : stream.window) {
    const std::int64_t since = pose.time_us - *stream.begin_us;
    if (since > until - window_us && since <= until) result.push_back(pose);
  }
  return result;
}

/// Returns whether another offset came into force.
bool estimate(ClockState& state, double max_gap) {
  const std::optional<TimeOffset> here = estimate_time_offset(
      part(state.streams[0], state.next_us), part(state.streams[1], state.next_us), {.max_gap = max_gap});
  if (here) state.newest = here;
  if (!here || !good(*here)) return false;
  const double change = state.in_force ? std::abs(here->seconds - *state.in_force) : INFINITY;
  if (change < least_change || change < change_sigmas * here->stddev) return false;
  state.in_force = here->seconds;
  ++state.changes;
  return true;
}

}  // namespace

std::vector<ReleasedPose> follow_clock(ClockState& state, Side side, const StampedPose& pose,
                                       double max_gap) {
  ClockState::Stream& stream = state.streams[side == Side::a ? 0 : 1];
  if (!stream.begin_us) stream.begin_us = pose.time_us;
  stream.window.push_back(pose);
  while (stream.window.back().time_us - stream.window.front().time_us > longest_us) {
    stream.window.pop_front();
    if (!state.in_force) ++state.given_up;
  }
  if (state.next_us == 0) state.next_us = first_us;

  const auto reached = [&](const ClockState::Stream& one) {
    return one.begin_us && one.window.back().time_us - *one.begin_us >= state.next_us;
  };
  const bool held = !state.in_force;
  std::vector<ReleasedPose> released;
  if (!held) released.push_back({side, shifted(pose, side, *state.in_force)});
  while (reached(state.streams[0]) && reached(state.streams[1])) {
    estimate(state, max_gap);
    state.next_us += state.in_force ? every_us : first_us;
  }
  if (held && state.in_force)
    for (const Side each : {Side::a, Side::b})
      for (const StampedPose& waiting : state.streams[each == Side::a ? 0 : 1].window)
        released.push_back({each, shifted(waiting, each, *state.in_force)});
  return released;
}

}  // namespace egocal
