// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/stream.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "egocal/microseconds.hpp"
#include "pairing/stream_parts.hpp"

namespace egocal {

namespace {

bool has_time(const std::map<std::int64_t, NumberedPose>& samples, std::int64_t time_us) {
  return std::any_of(samples.begin(), samples.end(),
                     [time_us](const auto& entry) { return entry.second.pose.time_us == time_us; });
}

}  // namespace

Stream::Stream(const StreamOptions& options) : options_(options) {
  state_.recent.fill(detail::no_time);
}

/// Whether a new message has the stamp of the one before. Its number has then arrived and is not missing.
bool Stream::repeats_a_stamp(const NumberedPose& sample) const {
  if (sample.seq < 0 || !state_.next_seq || sample.seq < *state_.next_seq) return false;
  const auto next = state_.early.lower_bound(sample.seq);
  if (next != state_.early.end() && next->first == sample.seq) return false;
  const std::optional<std::int64_t> before =
      next == state_.early.begin() ? state_.newest_us : std::prev(next)->second.pose.time_us;
  return before == sample.pose.time_us && plausible(sample);
}

bool Stream::known(std::int64_t time_us) const {
  return std::find(state_.recent.begin(), state_.recent.end(), time_us) != state_.recent.end() ||
         has_time(state_.early, time_us);
}

std::size_t Stream::unconfirmed() const {
  const bool numbered = !state_.candidates.empty() && state_.candidates.front().seq >= 0;
  return state_.patient && numbered ? state_.candidates.size() : 0;
}

/// The newest time of all poses, with those that wait behind a gap; newest_us is known.
std::int64_t Stream::newest_us_of_all() const {
  return state_.early.empty() ? *state_.newest_us : detail::newest_time(state_.early);
}

void Stream::remember(std::int64_t time_us) {
  state_.recent[state_.recent_next] = time_us;
  state_.recent_next = (state_.recent_next + 1) % state_.recent.size();
}

/// Counts and remembers a late message. One that is sent repeatedly is late once, then a duplicate, and
/// begins no new timeline.
void Stream::reject_late(const NumberedPose& sample) {
  ++state_.counts.out_of_order;
  remember(sample.pose.time_us);
}

void Stream::release(NumberedPose sample, std::vector<NumberedPose>& out) {
  const bool late = state_.newest_us && sample.pose.time_us <= *state_.newest_us;
  if (late && sample.seq >= 0 && sample.pose.time_us == *state_.newest_us) {
    ++state_.counts.duplicate;  // its stamp came before under another number
    return;
  }
  if (late && sample.seq >= 0) return reject_late(sample);
  if (late) {
    // without numbers nothing waited for it; the synchroniser decides whether it can still be used
    remember(sample.pose.time_us);
    out.push_back(std::move(sample));
    return;
  }
  if (state_.newest_us) state_.period_us = sample.pose.time_us - *state_.newest_us;
  state_.newest_us = sample.pose.time_us;
  remember(sample.pose.time_us);
  out.push_back(std::move(sample));
}

/// A lost message that arrives after all is known to be late, however old it is, and no longer counts as
/// lost.
void Stream::give_up_until(std::int64_t number) {
  state_.counts.lost += number - *state_.next_seq;
  // only the newest are remembered, so that a large gap costs no more than a small one
  for (std::int64_t lost = std::max(*state_.next_seq, number - options_.most_missing); lost < number; ++lost)
    state_.lost.insert(lost);
  state_.next_seq = number;
  while (too_many(state_.lost.size())) state_.lost.erase(state_.lost.begin());
}

void Stream::release_early(std::vector<NumberedPose>& out, bool give_up) {
  while (!state_.early.empty()) {
    const auto first = state_.early.begin();
    if (first->first != *state_.next_seq) {
      const bool waited_enough =
          too_many(state_.early.size()) ||
          (!state_.patient && detail::newest_time(state_.early) - first->second.pose.time_us >=
                                  to_microseconds(options_.reorder_window));
      if (!give_up && !waited_enough) return;
      give_up_until(first->first);
    }
    state_.next_seq = first->first + 1;
    release(first->second, out);
    state_.early.erase(first);
    // a damaged number may have put a pose far ahead, where it will be of no use
    state_.counts.out_of_order += static_cast<std::int64_t>(std::erase_if(
        state_.early, [this](const auto& entry) { return entry.second.pose.time_us < *state_.newest_us; }));
  }
}

std::optional<std::int64_t> Stream::behind_gap_us() const {
  if (state_.early.empty()) return std::nullopt;
  return state_.early.begin()->second.pose.time_us;
}

std::vector<NumberedPose> Stream::give_up_first_gap() {
  std::vector<NumberedPose> out;
  if (state_.early.empty()) return out;
  give_up_until(state_.early.begin()->first);
  release_early(out, false);
  return out;
}

std::vector<NumberedPose> Stream::flush() {
  std::vector<NumberedPose> out = settled();
  while (!state_.ahead.empty()) pass_checked(out);
  release_early(out, true);
  return out;
}

std::vector<NumberedPose> Stream::push(NumberedPose sample) {
  if (!detail::possible(sample)) {
    ++state_.counts.jump;
    return {};
  }
  if (state_.newest_us && sample.pose.time_us <= *state_.newest_us) ++repeated_;
  if (state_.settling) return hold(std::move(sample));
  return options_.look_ahead ? look_ahead(std::move(sample)) : in_order(std::move(sample));
}

/// Counts repetitions of the first message behind a gap. When a patient stream gets it again and again,
/// nothing will fill the gap.
std::vector<NumberedPose> Stream::count_repeated(std::int64_t time_us) {
  ++state_.counts.duplicate;
  drop_late_candidates(time_us);
  if (!state_.patient || behind_gap_us() != time_us) return {};
  if (std::exchange(state_.gap, *state_.next_seq) != state_.gap) state_.gap_repeats = 0;
  if (++state_.gap_repeats < options_.repeats_of_nothing) return {};
  return give_up_first_gap();
}

std::vector<NumberedPose> Stream::in_order(NumberedPose sample) {
  if (repeats_a_stamp(sample)) return place(std::move(sample));
  if (known(sample.pose.time_us)) return count_repeated(sample.pose.time_us);
  if (sample.seq >= 0 && state_.newest_us && sample.pose.time_us < *state_.newest_us &&
      state_.lost.erase(sample.seq) > 0) {
    reject_late(sample);
    --state_.counts.lost;
    return {};
  }
  if (!plausible(sample)) return confirm_jump(std::move(sample));
  return state_.candidates.empty() ? place(std::move(sample)) : place_before_candidates(std::move(sample));
}

std::vector<NumberedPose> Stream::place(NumberedPose sample) {
  std::vector<NumberedPose> out;
  if (sample.seq < 0 || !state_.next_seq) {
    if (sample.seq >= 0) state_.next_seq = sample.seq + 1;
    release(std::move(sample), out);
  } else if (sample.seq < *state_.next_seq) {
    reject_late(sample);
  } else {
    const std::int64_t seq = sample.seq;
    if (state_.early.emplace(seq, std::move(sample)).second)
      release_early(out, false);
    else
      ++state_.counts.duplicate;
  }
  return out;
}

}  // namespace egocal
