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

/// y may be the message after x, or a few later.
bool follows(const Sample& x, const Sample& y) {
  const std::int64_t step = y.pose.time_us - x.pose.time_us;
  if (step <= 0 || step > largest_step_us) return false;
  if (x.seq < 0 || y.seq < 0) return x.seq == y.seq;
  return y.seq > x.seq && y.seq - x.seq <= largest_number_step;
}

}  // namespace

Stream::Stream(double reorder_window_s)
    : reorder_window_us_(static_cast<std::int64_t>(reorder_window_s * 1e6)) {
  recent_.fill(-1);
}

bool Stream::known(std::int64_t time_us) const {
  return std::find(recent_.begin(), recent_.end(), time_us) != recent_.end() ||
         std::any_of(early_.begin(), early_.end(),
                     [time_us](const auto& entry) { return entry.second.pose.time_us == time_us; });
}

bool Stream::plausible(const Sample& sample) const {
  if (!newest_us_) return true;
  const std::int64_t limit = std::max(second_us, 4 * period_us_);
  const std::int64_t newest = early_.empty() ? *newest_us_ : early_.rbegin()->second.pose.time_us;
  if (sample.pose.time_us < *newest_us_ - limit || sample.pose.time_us > newest + limit) return false;
  return sample.seq < 0 || !next_seq_ || std::abs(sample.seq - *next_seq_) <= largest_number_step;
}

void Stream::release(Sample sample, std::vector<Sample>& out) {
  if (newest_us_ && sample.pose.time_us <= *newest_us_) {
    ++counts_.out_of_order;
    return;
  }
  if (newest_us_) period_us_ = sample.pose.time_us - *newest_us_;
  newest_us_ = sample.pose.time_us;
  recent_[recent_next_] = sample.pose.time_us;
  recent_next_ = (recent_next_ + 1) % recent_.size();
  out.push_back(std::move(sample));
}

void Stream::release_early(std::vector<Sample>& out, bool give_up) {
  while (!early_.empty()) {
    const auto first = early_.begin();
    const bool waited_enough =
        early_.rbegin()->second.pose.time_us - first->second.pose.time_us >= reorder_window_us_ ||
        early_.size() > max_early;
    if (first->first != *next_seq_) {
      if (!give_up && !waited_enough) return;
      counts_.lost += first->first - *next_seq_;
    }
    next_seq_ = first->first + 1;
    release(first->second, out);
    early_.erase(first);
  }
}

std::vector<Sample> Stream::flush() {
  std::vector<Sample> out;
  release_early(out, true);
  return out;
}

std::vector<Sample> Stream::take_candidates() {
  std::vector<Sample> out = flush();
  const bool backwards = candidates_.front().pose.time_us <= *newest_us_;
  if (backwards) {
    newest_us_.reset();
    recent_.fill(-1);
    candidates_.front().begins_anew = true;
  }
  next_seq_.reset();
  for (Sample& sample : std::exchange(candidates_, {})) {
    if (next_seq_ && sample.seq > *next_seq_) counts_.lost += sample.seq - *next_seq_;
    if (sample.seq >= 0) next_seq_ = sample.seq + 1;
    release(std::move(sample), out);
  }
  return out;
}

std::vector<Sample> Stream::push(Sample sample) {
  if (known(sample.pose.time_us)) {
    ++counts_.duplicate;
    return {};
  }
  if (!plausible(sample)) {
    if (!candidates_.empty() && !follows(candidates_.back(), sample)) {
      counts_.jump += static_cast<std::int64_t>(candidates_.size());
      candidates_.clear();
    }
    candidates_.push_back(std::move(sample));
    if (candidates_.size() < confirmations) return {};
    return take_candidates();
  }
  counts_.jump += static_cast<std::int64_t>(candidates_.size());
  candidates_.clear();

  std::vector<Sample> out;
  if (sample.seq < 0 || !next_seq_) {
    if (sample.seq >= 0) next_seq_ = sample.seq + 1;
    release(std::move(sample), out);
  } else if (sample.seq < *next_seq_) {
    ++counts_.out_of_order;
    if (counts_.lost > 0) --counts_.lost;
  } else {
    const std::int64_t seq = sample.seq;
    if (!early_.emplace(seq, std::move(sample)).second) {
      ++counts_.duplicate;
      return out;
    }
    release_early(out, false);
  }
  return out;
}

}  // namespace egocal::services
