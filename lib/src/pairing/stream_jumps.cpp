// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages whose time or number is far off: they are kept until others confirm them.
#include <algorithm>
#include <iterator>
#include <utility>

#include "egocal/microseconds.hpp"
#include "egocal/pairing/stream.hpp"
#include "pairing/stream_parts.hpp"

namespace egocal {

namespace {

/// After a gap in time: whether the missing numbers are lost messages. If they are many more than the time
/// allows, the sender has started another count.
bool lost_between(const StreamState& state, const NumberedPose& next, const StreamOptions& options) {
  if (next.seq < 0 || !state.next_seq || next.seq < *state.next_seq) return false;
  const std::int64_t ahead = next.seq - *state.next_seq, gap_us = next.pose.time_us - *state.newest_us;
  return ahead <= options.most_missing ||
         (state.period_us > 0 && ahead / options.jump_periods <= gap_us / state.period_us);
}

}  // namespace

/// Whether y may be the message after x, or a few later.
bool Stream::follows(const NumberedPose& x, const NumberedPose& y) const {
  const std::int64_t step = y.pose.time_us - x.pose.time_us;
  if (step <= 0 || step > to_microseconds(options_.largest_confirming_step)) return false;
  return detail::sent_in_order(x, y) && y.seq - x.seq <= options_.most_missing;
}

/// The place of the message among the candidates, after the one that it follows and before the one that
/// follows it, as the network may have changed their order. -1: it contradicts them.
std::ptrdiff_t Stream::place_among_candidates(const NumberedPose& sample) const {
  const std::vector<NumberedPose>& others = state_.candidates;
  const auto next = std::find_if(others.begin(), others.end(), [&](const NumberedPose& other) {
    return other.pose.time_us > sample.pose.time_us;
  });
  if (next != others.end() && !follows(sample, *next)) return -1;
  if (next != others.begin() && !follows(*std::prev(next), sample)) return -1;
  return next - others.begin();
}

std::int64_t Stream::largest_jump_us() const {
  return std::max(to_microseconds(options_.largest_jump), options_.jump_periods * state_.period_us);
}

/// A sender that repeats this message is sending the same timeline again. A message just before it that came
/// for the first time had been lost: it is late now and begins no new timeline.
void Stream::drop_late_candidates(std::int64_t repeated_us) {
  if (state_.candidates.empty() || !state_.newest_us) return;
  const std::int64_t last_us = state_.candidates.back().pose.time_us;
  if (last_us > repeated_us || repeated_us - last_us > largest_jump_us()) return;
  for (const NumberedPose& candidate : std::exchange(state_.candidates, {})) reject_late(candidate);
}

/// Without numbers: whether the message is among those that a player may still repeat (as many as are
/// remembered). Such messages were lost the first time, and begin no new timeline however many come in a row.
bool Stream::sent_again_too_late(const NumberedPose& sample) const {
  if (!state_.patient || sample.seq >= 0 || !state_.newest_us || sample.pose.time_us >= *state_.newest_us)
    return false;
  std::int64_t oldest_us = *state_.newest_us, not_remembered = 0;
  for (const std::int64_t time_us : state_.recent)
    if (time_us == detail::no_time)
      ++not_remembered;
    else
      oldest_us = std::min(oldest_us, time_us);
  return sample.pose.time_us >= oldest_us - not_remembered * state_.period_us;
}

bool Stream::plausible(const NumberedPose& sample) const {
  if (!state_.newest_us) return true;
  const std::int64_t limit = largest_jump_us();
  const std::int64_t newest = newest_us_of_all();
  // numbers that are missing take their time
  std::int64_t ahead = 0;
  if (sample.seq >= 0 && state_.next_seq) {
    ahead = sample.seq - *state_.next_seq;
    if (ahead > options_.most_missing || ahead < -options_.most_missing) return false;
  }
  return sample.pose.time_us >= *state_.newest_us - limit &&
         sample.pose.time_us <= newest + limit + std::max<std::int64_t>(0, ahead) * state_.period_us;
}

std::vector<NumberedPose> Stream::take_candidates() {
  std::vector<NumberedPose> out;
  const bool backwards = state_.candidates.front().pose.time_us <= newest_us_of_all();
  if (state_.patient && !backwards && lost_between(state_, state_.candidates.front(), options_) &&
      state_.candidates.front().seq - *state_.next_seq <= options_.most_missing) {
    // many were lost in a row, and will be sent again
    for (NumberedPose& sample : std::exchange(state_.candidates, {})) {
      const std::int64_t seq = sample.seq;
      if (!state_.early.emplace(seq, std::move(sample)).second) ++state_.counts.jump;
    }
    release_early(out, false);
    return out;
  }
  release_early(out, true);
  if (backwards) {
    state_.newest_us.reset();
    state_.recent.fill(detail::no_time);
    state_.lost.clear();
    state_.candidates.front().begins_anew = true;
  }
  if (backwards || !lost_between(state_, state_.candidates.front(), options_)) state_.next_seq.reset();
  for (NumberedPose& sample : std::exchange(state_.candidates, {})) {
    if (state_.next_seq && sample.seq > *state_.next_seq) give_up_until(sample.seq);
    if (sample.seq >= 0) state_.next_seq = sample.seq + 1;
    release(std::move(sample), out);
  }
  return out;
}

/// Confirms a jump by messages in a row. A copy made by the network contradicts nothing.
std::vector<NumberedPose> Stream::confirm_jump(NumberedPose sample) {
  const auto same = [&](const NumberedPose& candidate) {
    return candidate.pose.time_us == sample.pose.time_us && candidate.seq == sample.seq;
  };
  if (sent_again_too_late(sample)) {
    reject_late(sample);
    return {};
  }
  if (std::any_of(state_.candidates.begin(), state_.candidates.end(), same)) {
    ++state_.counts.duplicate;
    return {};
  }
  const std::ptrdiff_t at = place_among_candidates(sample);
  if (at < 0) {
    state_.counts.jump += static_cast<std::int64_t>(state_.candidates.size());
    state_.candidates.clear();
  }
  state_.candidates.insert(state_.candidates.begin() + std::max<std::ptrdiff_t>(0, at), std::move(sample));
  if (state_.candidates.size() < options_.confirmations) return {};
  return take_candidates();
}

/// A message that is not far off has come instead of one that would confirm the candidates.
std::vector<NumberedPose> Stream::place_before_candidates(NumberedPose sample) {
  const std::vector<NumberedPose> candidates = std::exchange(state_.candidates, {});
  const NumberedPose believed = sample;
  std::vector<NumberedPose> out = place(std::move(sample));
  for (const NumberedPose& candidate : candidates)
    // far off only because some of those in between were late
    if (candidate.seq >= 0 && follows(believed, candidate) && plausible(candidate))
      detail::append(out, place(candidate));
    else
      ++state_.counts.jump;
  return out;
}

}  // namespace egocal
