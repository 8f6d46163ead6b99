// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/followed_clock.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"

namespace egocal::services {

void FollowedClock::add(std::int64_t time_us, std::int64_t offset_us) {
  const std::size_t n = offsets_.size();
  if (n > 0 && time_us <= offsets_.back().time_us) {
    if (time_us == offsets_.back().time_us) offsets_.back().offset_us = offset_us;
    return;
  }
  const auto changed = [&](std::int64_t from, std::int64_t to) {
    return std::abs(to - from) >= options_.least_change_us;
  };
  const bool still = n > 1 && !changed(offsets_[n - 2].offset_us, offsets_[n - 1].offset_us) &&
                     !changed(offsets_[n - 2].offset_us, offset_us);
  if (still)
    offsets_.back() = {time_us, offset_us};
  else
    offsets_.push_back({time_us, offset_us});
  if (offsets_.size() <= options_.most) return;
  std::vector<OffsetSince> kept;
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    if (i % 2 == 0 || i + 1 == offsets_.size()) kept.push_back(offsets_[i]);
  offsets_ = std::move(kept);
}

/// The offsets as they would be if the clock had never been set.
std::vector<OffsetSince> FollowedClock::without_jumps() const {
  std::vector<OffsetSince> result = offsets_;
  std::int64_t set_by = 0;
  for (std::size_t i = result.size(); i-- > 1;) {
    const OffsetSince &from = offsets_[i - 1], &to = offsets_[i];
    const std::int64_t change = to.offset_us - from.offset_us;
    const double least = options_.least_jump_rate * static_cast<double>(to.time_us - from.time_us);
    if (std::abs(change) >= options_.least_jump_us && static_cast<double>(std::abs(change)) > least)
      set_by += change;
    result[i - 1].offset_us += set_by;
  }
  return result;
}

namespace {

std::int64_t offset_at(const std::vector<OffsetSince>& offsets, std::int64_t time_us) {
  const auto after =
      std::upper_bound(offsets.begin(), offsets.end(), time_us,
                       [](std::int64_t time, const OffsetSince& offset) { return time < offset.time_us; });
  if (after == offsets.begin()) return offsets.front().offset_us;
  if (after == offsets.end()) return offsets.back().offset_us;
  const OffsetSince &from = *std::prev(after), &to = *after;
  const double part =
      static_cast<double>(time_us - from.time_us) / static_cast<double>(to.time_us - from.time_us);
  return from.offset_us + std::llround(part * static_cast<double>(to.offset_us - from.offset_us));
}

}  // namespace

Trajectory FollowedClock::at_newest_offset(Trajectory b) const {
  if (offsets_.empty()) return b;
  const std::vector<OffsetSince> offsets = without_jumps();
  const std::int64_t newest = offsets.back().offset_us;
  Trajectory result;
  result.reserve(b.size());
  for (StampedPose& pose : b) {
    // at its own time of a, which the offset itself moves: what a drift of 1 % leaves is squared
    const std::int64_t about = pose.time_us + offset_at(offsets, pose.time_us + newest);
    pose.time_us += offset_at(offsets, about) - newest;
    // where pairing found another offset, poses may change places
    if (result.empty() || pose.time_us > result.back().time_us) result.push_back(pose);
  }
  return result;
}

void FollowedClock::restore(std::vector<OffsetSince> offsets) {
  const auto plausible = [](const OffsetSince& offset) {
    return plausible_relative_time(offset.time_us) && std::abs(offset.offset_us) <= limits::latest_us;
  };
  const auto not_later = [](const OffsetSince& x, const OffsetSince& y) { return y.time_us <= x.time_us; };
  if (offsets.size() > options_.most || !std::all_of(offsets.begin(), offsets.end(), plausible) ||
      std::adjacent_find(offsets.begin(), offsets.end(), not_later) != offsets.end())
    throw Error("holds clock offsets that no drive can have");
  offsets_ = std::move(offsets);
}

}  // namespace egocal::services
