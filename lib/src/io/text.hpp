// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace egocal::detail {

/// One line of a text file that holds data: comments (#) and empty lines are left out.
struct Line {
  long number = 0;  ///< from 1
  std::string text;
};
/// Throws Error where the file cannot be read or holds no data.
std::vector<Line> read_lines(const std::string& file);

std::vector<std::string_view> fields(std::string_view text, bool commas);

/// A finite number. Throws Error naming file, line and field.
double number(const std::string& file, long line, const std::string& field, std::string_view text);

/// A time in microseconds from its decimal text, rounded once, in seconds (TUM, KITTI) or nanoseconds
/// (EuRoC). Throws Error naming file and line.
enum class TimeUnit { seconds, nanoseconds };
std::int64_t time_us(const std::string& file, long line, std::string_view text, TimeUnit unit);

}  // namespace egocal::detail
