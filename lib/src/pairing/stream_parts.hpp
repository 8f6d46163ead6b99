// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "egocal/pairing/stream.hpp"

/// What the files of Stream share.
namespace egocal::detail {

/// In StreamState::recent: nothing yet.
constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::min();

inline std::int64_t microseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e6);
}

/// What every calculation with it relies on: differences and products of such values do not overflow.
bool possible(const NumberedPose& sample);

/// They are recorded in the order in which they were sent.
bool sent_in_order(const NumberedPose& x, const NumberedPose& y);

void append(std::vector<NumberedPose>& out, std::vector<NumberedPose> more);

/// Of all that wait (not none) [us]: a damaged number may be the highest with an early time.
std::int64_t newest_time(const std::map<std::int64_t, NumberedPose>& samples);

}  // namespace egocal::detail
