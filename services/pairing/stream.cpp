// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/stream.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace egocal::services {

namespace {

constexpr std::int64_t second_us = 1'000'000;
constexpr std::int64_t largest_step_us =
    60 * second_us;  // between messages that support each other after a jump
constexpr std::int64_t largest_number_step = 1000;
constexpr std::size_t confirmations = 3;
constexpr std::size_t max_early = 1000;
constexpr std::int32_t repeats_of_nothing = 2;

/// y may be the message after x, or a few later.
bool follows(const Sample& x, const Sample& y) {
  const std::int64_t step = y.pose.time_us - x.pose.time_us;
  if (step <= 0 || step > largest_step_us) return false;
  if (x.seq < 0 || y.seq < 0) return x.seq == y.seq;
  return y.seq > x.seq && y.seq - x.seq <= largest_number_step;
}

bool has_time(const std::map<std::int64_t, Sample>& samples, std::int64_t time_us) {
  return std::any_of(samples.begin(), samples.end(),
                     [time_us](const auto& entry) { return entry.second.pose.time_us == time_us; });
}

/// Of all that wait: a damaged number may be the highest with an early time.
std::int64_t newest_time(const std::map<std::int64_t, Sample>& samples) {
  std::int64_t newest = samples.begin()->second.pose.time_us;
  for (const auto& [number, sample] : samples) newest = std::max(newest, sample.pose.time_us);
  return newest;
}

}  // namespace

Stream::Stream(double reorder_window_s)
    : reorder_window_us_(static_cast<std::int64_t>(reorder_window_s * 1e6)) {
  state_.recent.fill(-1);
}

bool Stream::known(std::int64_t time_us) const {
  return std::find(state_.recent.begin(), state_.recent.end(), time_us) != state_.recent.end() ||
         has_time(state_.early, time_us);
}

bool Stream::plausible(const Sample& sample) const {
  if (!state_.newest_us) return true;
  const std::int64_t limit = std::max(second_us, 4 * state_.period_us);
  const std::int64_t newest = state_.early.empty() ? *state_.newest_us : newest_time(state_.early);
  // numbers that are missing take their time
  std::int64_t ahead = 0;
  if (sample.seq >= 0 && state_.next_seq) {
    ahead = sample.seq - *state_.next_seq;
    if (std::abs(ahead) > largest_number_step) return false;
  }
  return sample.pose.time_us >= *state_.newest_us - limit &&
         sample.pose.time_us <= newest + limit + std::max<std::int64_t>(0, ahead) * state_.period_us;
}

void Stream::release(Sample sample, std::vector<Sample>& out) {
  const bool late = state_.newest_us && sample.pose.time_us <= *state_.newest_us;
  if (late && sample.seq >= 0) {
    ++state_.counts.out_of_order;
    return;
  }
  if (late) {
    // without a number nobody waited for it; whether it can still be of use the drive knows
    state_.recent[state_.recent_next] = sample.pose.time_us;
    state_.recent_next = (state_.recent_next + 1) % state_.recent.size();
    out.push_back(std::move(sample));
    return;
  }
  if (state_.newest_us) state_.period_us = sample.pose.time_us - *state_.newest_us;
  state_.newest_us = sample.pose.time_us;
  state_.recent[state_.recent_next] = sample.pose.time_us;
  state_.recent_next = (state_.recent_next + 1) % state_.recent.size();
  out.push_back(std::move(sample));
}

/// What comes after all is known to be late, however old it is, and is no longer counted as lost.
void Stream::give_up_until(std::int64_t number) {
  state_.counts.lost += number - *state_.next_seq;
  for (; *state_.next_seq < number; ++*state_.next_seq) state_.lost.insert(*state_.next_seq);
  while (state_.lost.size() > max_early) state_.lost.erase(state_.lost.begin());
}

void Stream::release_early(std::vector<Sample>& out, bool give_up) {
  while (!state_.early.empty()) {
    const auto first = state_.early.begin();
    if (first->first != *state_.next_seq) {
      const bool waited_enough =
          state_.early.size() > max_early ||
          (!state_.patient && newest_time(state_.early) - first->second.pose.time_us >= reorder_window_us_);
      if (!give_up && !waited_enough) return;
      give_up_until(first->first);
    }
    state_.next_seq = first->first + 1;
    release(first->second, out);
    state_.early.erase(first);
    // a damaged number may have put one far ahead that will not be of use there
    state_.counts.out_of_order += static_cast<std::int64_t>(std::erase_if(
        state_.early, [this](const auto& entry) { return entry.second.pose.time_us <= *state_.newest_us; }));
  }
}

void Stream::give_up_first_gap(std::vector<Sample>& out) {
  give_up_until(state_.early.begin()->first);
  release_early(out, false);
}

std::vector<Sample> Stream::flush() {
  std::vector<Sample> out = settled();
  release_early(out, true);
  return out;
}

std::vector<Sample> Stream::take_candidates() {
  std::vector<Sample> out;
  release_early(out, true);
  const bool backwards = state_.candidates.front().pose.time_us <= *state_.newest_us;
  if (backwards) {
    state_.newest_us.reset();
    state_.recent.fill(-1);
    state_.lost.clear();
    state_.candidates.front().begins_anew = true;
  }
  state_.next_seq.reset();
  for (Sample& sample : std::exchange(state_.candidates, {})) {
    if (state_.next_seq && sample.seq > *state_.next_seq) give_up_until(sample.seq);
    if (sample.seq >= 0) state_.next_seq = sample.seq + 1;
    release(std::move(sample), out);
  }
  return out;
}

void Stream::settle() {
  state_.settling = !state_.next_seq;
  state_.gap_repeats = 0;
  state_.held.clear();  // not acknowledged yet: they come again, in order
}

std::vector<Sample> Stream::settled() {
  state_.settling = false;
  std::vector<Sample> out;
  for (auto& [time_us, sample] : std::exchange(state_.held, {})) {
    std::vector<Sample> more = put_in_order(std::move(sample));
    std::move(more.begin(), more.end(), std::back_inserter(out));
  }
  return out;
}

std::vector<Sample> Stream::hold(Sample sample) {
  const std::int64_t time_us = sample.pose.time_us;
  const bool backwards = state_.newest_us && time_us <= *state_.newest_us;
  const bool again = state_.held.contains(time_us);
  if (!backwards && !again && state_.held.size() < max_early) {
    state_.held.emplace(time_us, std::move(sample));
    return {};
  }
  if (backwards && known(time_us)) {  // the sender has begun a little before what is missing
    ++state_.counts.duplicate;
    return {};
  }
  std::vector<Sample> out = settled();
  std::vector<Sample> more = put_in_order(std::move(sample));
  std::move(more.begin(), more.end(), std::back_inserter(out));
  return out;
}

std::vector<Sample> Stream::push(Sample sample) {
  if (state_.settling) return hold(std::move(sample));
  return put_in_order(std::move(sample));
}

std::vector<Sample> Stream::put_in_order(Sample sample) {
  if (known(sample.pose.time_us)) {
    ++state_.counts.duplicate;
    std::vector<Sample> out;
    if (state_.patient && !state_.early.empty() &&
        state_.early.begin()->second.pose.time_us == sample.pose.time_us) {
      if (std::exchange(state_.gap, *state_.next_seq) != state_.gap) state_.gap_repeats = 0;
      if (++state_.gap_repeats == repeats_of_nothing) give_up_first_gap(out);
    }
    return out;
  }
  if (sample.seq >= 0 && state_.newest_us && sample.pose.time_us < *state_.newest_us &&
      state_.lost.erase(sample.seq) > 0) {
    ++state_.counts.out_of_order;
    --state_.counts.lost;
    return {};
  }
  if (!plausible(sample)) {
    if (!state_.candidates.empty() && !follows(state_.candidates.back(), sample)) {
      state_.counts.jump += static_cast<std::int64_t>(state_.candidates.size());
      state_.candidates.clear();
    }
    state_.candidates.push_back(std::move(sample));
    if (state_.candidates.size() < confirmations) return {};
    return take_candidates();
  }
  state_.counts.jump += static_cast<std::int64_t>(state_.candidates.size());
  state_.candidates.clear();

  std::vector<Sample> out;
  if (sample.seq < 0 || !state_.next_seq) {
    if (sample.seq >= 0) state_.next_seq = sample.seq + 1;
    release(std::move(sample), out);
  } else if (sample.seq < *state_.next_seq) {
    ++state_.counts.out_of_order;
  } else {
    const std::int64_t seq = sample.seq;
    if (!state_.early.emplace(seq, std::move(sample)).second) {
      ++state_.counts.duplicate;
      return out;
    }
    release_early(out, false);
  }
  return out;
}

}  // namespace egocal::services
