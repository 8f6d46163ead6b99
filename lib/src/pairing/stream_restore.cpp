// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A saved state is checked before it is used.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/stream.hpp"
#include "pairing/stream_parts.hpp"

namespace egocal {

void Stream::restore(StreamState state) {
  const auto all_possible = [](const auto& samples) {
    return std::all_of(samples.begin(), samples.end(),
                       [](const auto& entry) { return detail::possible(entry.second); });
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
      std::all_of(state.candidates.begin(), state.candidates.end(), detail::possible) &&
      std::all_of(state.ahead.begin(), state.ahead.end(), detail::possible) &&
      std::all_of(state.early.begin(), state.early.end(), [&](const auto& entry) {
        return entry.first == entry.second.seq && entry.first >= *state.next_seq &&
               entry.first - *state.next_seq <= 2 * options_.most_missing;
      });
  if (!fits) throw Error("holds values that no stream of poses can have");
  state_ = std::move(state);
}

}  // namespace egocal
