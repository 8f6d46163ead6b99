// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// After an interruption: messages are collected until the sender goes over them again.
#include <cstdint>
#include <utility>

#include "egocal/pairing/stream.hpp"
#include "pairing/stream_parts.hpp"

namespace egocal {

void Stream::settle() {
  state_.settling = !state_.next_seq;
  state_.going_over = false;
  state_.gap_repeats = 0;
  state_.held_last_us.reset();
  state_.held_before = !state_.held.empty();
}

std::vector<NumberedPose> Stream::end_settling() {
  return state_.settling ? settled() : std::vector<NumberedPose>{};
}

std::vector<NumberedPose> Stream::settled() {
  state_.settling = state_.held_before = state_.going_over = false;
  std::vector<NumberedPose> out;
  for (auto& [time_us, sample] : std::exchange(state_.held, {})) {
    detail::append(out, in_order(std::move(sample)));
  }
  return out;
}

std::vector<NumberedPose> Stream::hold(NumberedPose sample) {
  if (std::exchange(state_.held_before, false)) {
    // not acknowledged: the sender is there, and will send them again in order
    state_.counts.duplicate += static_cast<std::int64_t>(state_.held.size());
    state_.held.clear();
  }
  const std::int64_t time_us = sample.pose.time_us;
  const bool backwards = state_.newest_us && time_us <= *state_.newest_us;
  const bool again = state_.held.contains(time_us);
  const bool copy = std::exchange(state_.held_last_us, time_us) == time_us;  // made by the network
  const bool numbered = sample.seq >= 0;
  state_.going_over = state_.going_over || (again && !copy);
  if ((backwards && known(time_us)) || (again && (numbered || !state_.going_over))) {
    ++state_.counts.duplicate;
    return {};
  }
  if (!backwards && (numbered || !state_.going_over) && !too_many(state_.held.size() + 1)) {
    state_.held.emplace(time_us, std::move(sample));
    return {};
  }
  if (!numbered && !backwards && state_.going_over && time_us <= state_.held.rbegin()->first)
    return go_over(std::move(sample));
  std::vector<NumberedPose> out = settled();
  detail::append(out, in_order(std::move(sample)));
  return out;
}

/// Without numbers a missing message cannot be noticed among held ones. So each is released only when the
/// sender repeats it, as whatever precedes it has been sent by then.
std::vector<NumberedPose> Stream::go_over(NumberedPose sample) {
  const std::int64_t time_us = sample.pose.time_us;
  if (!state_.held.emplace(time_us, std::move(sample)).second) ++state_.counts.duplicate;
  std::vector<NumberedPose> out;
  while (!state_.held.empty() && state_.held.begin()->first <= time_us)
    detail::append(out, in_order(std::move(state_.held.extract(state_.held.begin()).mapped())));
  if (state_.held.empty()) settled();
  return out;
}

}  // namespace egocal
