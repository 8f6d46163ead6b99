// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace egocal::detail {

/// Microseconds since 1970 of a date and time of ISO 8601, "2026-11-22T02:30:00.125Z": 'T' or a blank between
/// date and time, any number of decimals (rounded), and Z or +HH:MM; without a zone it is UTC. Empty where
/// the text is anything else, or a date that does not exist.
std::optional<std::int64_t> calendar_time_us(std::string_view text);

}  // namespace egocal::detail
