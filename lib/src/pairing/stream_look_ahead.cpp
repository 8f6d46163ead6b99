// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// In recordings: time stamps are judged by their two neighbours.
#include <cstdint>
#include <utility>

#include "egocal/pairing/stream.hpp"
#include "pairing/stream_parts.hpp"

namespace egocal {

std::vector<NumberedPose> Stream::look_ahead(NumberedPose sample) {
  state_.ahead.push_back(std::move(sample));
  std::vector<NumberedPose> out;
  while (state_.ahead.size() >= 3) pass_checked(out);
  return out;
}

/// Passes the first of those ahead, unless its time contradicts that of the next one and leaving it out
/// restores the order. If that also holds for the next one, that one will be late.
void Stream::pass_checked(std::vector<NumberedPose>& out) {
  std::vector<NumberedPose>& ahead = state_.ahead;
  const std::int64_t time = ahead[0].pose.time_us;
  bool damaged = false;
  if (ahead.size() > 1 && detail::sent_in_order(ahead[0], ahead[1]) && ahead[1].pose.time_us < time) {
    const std::int64_t next = ahead[1].pose.time_us;
    const bool without_it = (!state_.checked_us || *state_.checked_us < next) &&
                            (ahead.size() < 3 || next < ahead[2].pose.time_us);
    const bool without_next = ahead.size() < 3 || time < ahead[2].pose.time_us;
    damaged = without_it && !without_next;
  }
  NumberedPose first = std::move(ahead.front());
  ahead.erase(ahead.begin());
  if (damaged) {
    ++state_.counts.jump;
    return;
  }
  state_.checked_us = time;
  detail::append(out, in_order(std::move(first)));
}

}  // namespace egocal
