// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/stream.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"

namespace egocal {

namespace {

constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::min();

std::int64_t microseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e6);
}

/// What every calculation below relies on: differences and products of such values do not overflow.
bool possible(const NumberedPose& sample) {
  return plausible_relative_time(sample.pose.time_us) && (sample.seq == -1 || plausible_count(sample.seq));
}

/// They are recorded in the order in which they were sent.
bool sent_in_order(const NumberedPose& x, const NumberedPose& y) {
  return x.seq < 0 || y.seq < 0 ? x.seq == y.seq : y.seq > x.seq;
}

void append(std::vector<NumberedPose>& out, std::vector<NumberedPose> more) {
  std::move(more.begin(), more.end(), std::back_inserter(out));
}

bool has_time(const std::map<std::int64_t, NumberedPose>& samples, std::int64_t time_us) {
  return std::any_of(samples.begin(), samples.end(),
                     [time_us](const auto& entry) { return entry.second.pose.time_us == time_us; });
}

/// Of all that wait (not none): a damaged number may be the highest with an early time.
std::int64_t newest_time(const std::map<std::int64_t, NumberedPose>& samples) {
  std::int64_t newest = samples.begin()->second.pose.time_us;
  for (const auto& [number, sample] : samples) newest = std::max(newest, sample.pose.time_us);
  return newest;
}

/// After a gap in time: whether the numbers in between are of messages that were lost. Where they are many
/// more than the time allows, the sender has begun to count elsewhere.
bool lost_between(const StreamState& state, const NumberedPose& next, const StreamOptions& options) {
  if (next.seq < 0 || !state.next_seq || next.seq < *state.next_seq) return false;
  const std::int64_t ahead = next.seq - *state.next_seq, gap_us = next.pose.time_us - *state.newest_us;
  return ahead <= options.most_missing ||
         (state.period_us > 0 && ahead / options.jump_periods <= gap_us / state.period_us);
}

}  // namespace

Stream::Stream(const StreamOptions& options) : options_(options) {
  state_.recent.fill(no_time);
}

/// A new message with the stamp of the one before it. Its number has come, and is not missing.
bool Stream::repeats_a_stamp(const NumberedPose& sample) const {
  if (sample.seq < 0 || !state_.next_seq || sample.seq < *state_.next_seq) return false;
  const auto next = state_.early.lower_bound(sample.seq);
  if (next != state_.early.end() && next->first == sample.seq) return false;
  const std::optional<std::int64_t> before =
      next == state_.early.begin() ? state_.newest_us : std::prev(next)->second.pose.time_us;
  return before == sample.pose.time_us && plausible(sample);
}

/// y may be the message after x, or a few later.
bool Stream::follows(const NumberedPose& x, const NumberedPose& y) const {
  const std::int64_t step = y.pose.time_us - x.pose.time_us;
  if (step <= 0 || step > microseconds(options_.largest_confirming_step)) return false;
  return sent_in_order(x, y) && y.seq - x.seq <= options_.most_missing;
}

/// Behind the one that it follows and before the one that follows it; the network may have changed their
/// order. -1: it contradicts them.
std::ptrdiff_t Stream::place_among_candidates(const NumberedPose& sample) const {
  const std::vector<NumberedPose>& others = state_.candidates;
  const auto next = std::find_if(others.begin(), others.end(), [&](const NumberedPose& other) {
    return other.pose.time_us > sample.pose.time_us;
  });
  if (next != others.end() && !follows(sample, *next)) return -1;
  if (next != others.begin() && !follows(*std::prev(next), sample)) return -1;
  return next - others.begin();
}

bool Stream::known(std::int64_t time_us) const {
  return std::find(state_.recent.begin(), state_.recent.end(), time_us) != state_.recent.end() ||
         has_time(state_.early, time_us);
}

std::size_t Stream::unconfirmed() const {
  const bool numbered = !state_.candidates.empty() && state_.candidates.front().seq >= 0;
  return state_.patient && numbered ? state_.candidates.size() : 0;
}

/// With those that wait behind a gap; newest_us is known.
std::int64_t Stream::newest_us_of_all() const {
  return state_.early.empty() ? *state_.newest_us : newest_time(state_.early);
}

std::int64_t Stream::largest_jump_us() const {
  return std::max(microseconds(options_.largest_jump), options_.jump_periods * state_.period_us);
}

/// A sender that repeats this one goes over the same timeline again: what came just before it for the first
/// time had been lost, is late now, and begins nothing.
void Stream::drop_late_candidates(std::int64_t repeated_us) {
  if (state_.candidates.empty() || !state_.newest_us) return;
  const std::int64_t last_us = state_.candidates.back().pose.time_us;
  if (last_us > repeated_us || repeated_us - last_us > largest_jump_us()) return;
  for (const NumberedPose& candidate : std::exchange(state_.candidates, {})) reject_late(candidate);
}

/// Without numbers: from among the messages that a player may still send again (as many as are remembered).
/// They were lost the first time, and begin no new timeline, however many come in a row.
bool Stream::sent_again_too_late(const NumberedPose& sample) const {
  if (!state_.patient || sample.seq >= 0 || !state_.newest_us || sample.pose.time_us >= *state_.newest_us)
    return false;
  std::int64_t oldest_us = *state_.newest_us, not_remembered = 0;
  for (const std::int64_t time_us : state_.recent)
    if (time_us == no_time)
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

void Stream::remember(std::int64_t time_us) {
  state_.recent[state_.recent_next] = time_us;
  state_.recent_next = (state_.recent_next + 1) % state_.recent.size();
}

/// Counted, and remembered: what is sent again and again is late once, then a duplicate, and begins no new
/// timeline.
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
    // not numbered, so nothing waited for it: the synchroniser knows whether it can still use it
    remember(sample.pose.time_us);
    out.push_back(std::move(sample));
    return;
  }
  if (state_.newest_us) state_.period_us = sample.pose.time_us - *state_.newest_us;
  state_.newest_us = sample.pose.time_us;
  remember(sample.pose.time_us);
  out.push_back(std::move(sample));
}

/// What comes after all is known to be late, however old it is, and is no longer counted as lost.
void Stream::give_up_until(std::int64_t number) {
  state_.counts.lost += number - *state_.next_seq;
  // only the newest are remembered: a large gap costs no more than a small one
  for (std::int64_t lost = std::max(*state_.next_seq, number - options_.most_missing); lost < number; ++lost)
    state_.lost.insert(lost);
  state_.next_seq = number;
  while (too_many(state_.lost.size())) state_.lost.erase(state_.lost.begin());
}

void Stream::release_early(std::vector<NumberedPose>& out, bool give_up) {
  while (!state_.early.empty()) {
    const auto first = state_.early.begin();
    if (first->first != *state_.next_seq) {
      const bool waited_enough = too_many(state_.early.size()) ||
                                 (!state_.patient && newest_time(state_.early) - first->second.pose.time_us >=
                                                         microseconds(options_.reorder_window));
      if (!give_up && !waited_enough) return;
      give_up_until(first->first);
    }
    state_.next_seq = first->first + 1;
    release(first->second, out);
    state_.early.erase(first);
    // a damaged number may have put one far ahead that will not be of use there
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

void Stream::restore(StreamState state) {
  const auto all_possible = [](const auto& samples) {
    return std::all_of(samples.begin(), samples.end(),
                       [](const auto& entry) { return possible(entry.second); });
  };
  const auto possible_time = [](const std::optional<std::int64_t>& time) {
    return !time || plausible_relative_time(*time);
  };
  const std::size_t most = static_cast<std::size_t>(options_.most_missing) + 1;
  const bool fits =
      possible_time(state.newest_us) && possible_time(state.checked_us) && state.period_us >= 0 &&
      state.period_us <= 2 * limits::latest_us &&
      (!state.next_seq || (*state.next_seq >= 0 && *state.next_seq <= limits::largest_count + 1)) &&
      state.early.size() <= most && state.held.size() <= most && state.lost.size() <= most &&
      state.candidates.size() <= options_.confirmations && state.ahead.size() <= 3 &&
      state.recent_next < state.recent.size() &&
      (state.early.empty() || (state.next_seq && state.newest_us)) &&
      (state.candidates.empty() || state.newest_us) && (!state.going_over || !state.held.empty()) &&
      all_possible(state.early) && all_possible(state.held) &&
      std::all_of(state.candidates.begin(), state.candidates.end(), possible) &&
      std::all_of(state.ahead.begin(), state.ahead.end(), possible) &&
      std::all_of(state.early.begin(), state.early.end(), [&](const auto& entry) {
        return entry.first == entry.second.seq && entry.first >= *state.next_seq &&
               entry.first - *state.next_seq <= 2 * options_.most_missing;
      });
  if (!fits) throw Error("holds values that no stream of poses can have");
  state_ = std::move(state);
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
    state_.recent.fill(no_time);
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
    append(out, in_order(std::move(sample)));
  }
  return out;
}

std::vector<NumberedPose> Stream::hold(NumberedPose sample) {
  if (std::exchange(state_.held_before, false)) {
    // not acknowledged: the sender is there, and they come again, in order
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
  append(out, in_order(std::move(sample)));
  return out;
}

/// Among held messages without numbers a missing one cannot be seen. So each is released only when the sender
/// repeats it: whatever belongs before it has been sent by then.
std::vector<NumberedPose> Stream::go_over(NumberedPose sample) {
  const std::int64_t time_us = sample.pose.time_us;
  if (!state_.held.emplace(time_us, std::move(sample)).second) ++state_.counts.duplicate;
  std::vector<NumberedPose> out;
  while (!state_.held.empty() && state_.held.begin()->first <= time_us)
    append(out, in_order(std::move(state_.held.extract(state_.held.begin()).mapped())));
  if (state_.held.empty()) settled();
  return out;
}

std::vector<NumberedPose> Stream::push(NumberedPose sample) {
  if (!possible(sample)) {
    ++state_.counts.jump;
    return {};
  }
  if (state_.newest_us && sample.pose.time_us <= *state_.newest_us) ++repeated_;
  if (state_.settling) return hold(std::move(sample));
  return options_.look_ahead ? look_ahead(std::move(sample)) : in_order(std::move(sample));
}

std::vector<NumberedPose> Stream::look_ahead(NumberedPose sample) {
  state_.ahead.push_back(std::move(sample));
  std::vector<NumberedPose> out;
  while (state_.ahead.size() >= 3) pass_checked(out);
  return out;
}

/// The first of those ahead is accepted, unless its time contradicts the next one's and order is restored by
/// leaving it out. Where that holds for the next one as well, that one will be too late.
void Stream::pass_checked(std::vector<NumberedPose>& out) {
  std::vector<NumberedPose>& ahead = state_.ahead;
  const std::int64_t time = ahead[0].pose.time_us;
  bool damaged = false;
  if (ahead.size() > 1 && sent_in_order(ahead[0], ahead[1]) && ahead[1].pose.time_us < time) {
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
  append(out, in_order(std::move(first)));
}

std::vector<NumberedPose> Stream::in_order(NumberedPose sample) {
  if (repeats_a_stamp(sample)) return place(std::move(sample));
  if (known(sample.pose.time_us)) {
    ++state_.counts.duplicate;
    drop_late_candidates(sample.pose.time_us);
    if (!state_.patient || behind_gap_us() != sample.pose.time_us) return {};
    if (std::exchange(state_.gap, *state_.next_seq) != state_.gap) state_.gap_repeats = 0;
    if (++state_.gap_repeats < options_.repeats_of_nothing) return {};
    return give_up_first_gap();
  }
  if (sample.seq >= 0 && state_.newest_us && sample.pose.time_us < *state_.newest_us &&
      state_.lost.erase(sample.seq) > 0) {
    reject_late(sample);
    --state_.counts.lost;
    return {};
  }
  if (!plausible(sample)) {
    if (sent_again_too_late(sample)) {
      reject_late(sample);
      return {};
    }
    // a copy, which the network made, contradicts nothing
    const auto same = [&](const NumberedPose& candidate) {
      return candidate.pose.time_us == sample.pose.time_us && candidate.seq == sample.seq;
    };
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
  if (state_.candidates.empty()) return place(std::move(sample));
  const std::vector<NumberedPose> candidates = std::exchange(state_.candidates, {});
  const NumberedPose believed = sample;
  std::vector<NumberedPose> out = place(std::move(sample));
  for (const NumberedPose& candidate : candidates)
    // far off only because some of those in between were late
    if (candidate.seq >= 0 && follows(believed, candidate) && plausible(candidate))
      append(out, place(candidate));
    else
      ++state_.counts.jump;
  return out;
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
