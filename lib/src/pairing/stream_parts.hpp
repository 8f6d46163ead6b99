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

/// Marks a place in StreamState::recent that holds nothing yet.
constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::min();

/// Whether values are in the range that every calculation relies on: differences and products do not
/// overflow.
bool possible(const NumberedPose& sample);

/// Whether two poses were recorded in the order in which they were sent.
bool sent_in_order(const NumberedPose& x, const NumberedPose& y);

void append(std::vector<NumberedPose>& out, std::vector<NumberedPose> more);

/// The newest time of those that wait (at least one) [us]. A damaged number may be the highest and have an
/// early time.
std::int64_t newest_time(const std::map<std::int64_t, NumberedPose>& samples);

}  // namespace egocal::detail
