// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace egocal::detail {

/// Appends the shortest text that reads back as the same double, with a decimal point whatever the locale of
/// the program is.
void append_number(std::string& text, double value);
/// Microseconds as seconds with six decimals.
void append_seconds(std::string& text, std::int64_t time_us);

}  // namespace egocal::detail
