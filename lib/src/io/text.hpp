// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/limits.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace egocal::detail {

/// The lower case of an ASCII letter, whatever the locale; other characters stay.
constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Rates of poses that have no times [Hz]: limits, within which the times of a billion rows can be told apart
/// and do not overflow.
inline constexpr Range rates_of_poses{1e-3, 1e6};

/// One line of a text file that holds data: comments (#) and empty lines are not among them.
struct Line {
  long number = 0;  ///< from 1
  std::string text;
};
/// Throws Error where the file cannot be read or holds no data.
std::vector<Line> read_lines(const std::string& file);

/// Fields between blanks, or between commas.
std::vector<std::string_view> fields(std::string_view text, bool commas);
/// The same into a vector that is kept between lines; separator: ' ' for blanks and tabs that merge, '\t',
/// ',' or ';'. A field in double quotes (RFC 4180) may hold separators, and is taken without its quotes.
/// Returns how many fields there are, empty ones at the end included, which are left away.
std::size_t split(std::string_view text, char separator, std::vector<std::string_view>& fields);

/// The line up to a '#' behind a blank, outside of quotes.
std::string_view without_comment(std::string_view line);
/// What programs write where there is no number: "nan", "-nan(ind)", "None", "null", "NA".
bool is_missing_number(std::string_view text);

/// The number that fills the whole text. False where there is none; it may be infinite or NaN.
bool parse_number(std::string_view text, double& value);
/// Whether this is a number like "1,25", of a country that writes decimals so.
bool has_decimal_comma(std::string_view text);
/// A finite number. Throws Error naming file, line and field.
double number(const std::string& file, long line, const std::string& field, std::string_view text);
/// The error of a text that is no finite number.
[[noreturn]] void throw_not_a_number(const std::string& file, long line, const std::string& field,
                                     std::string_view text);

/// What a text said, for one line that can be read: quoted, cut to 40 characters, no control characters.
std::string quoted(std::string_view text);

/// Unit of the numbers in a column of times: the power of ten that makes microseconds of them.
enum class TimeUnit { seconds = 6, milliseconds = 3, microseconds = 0, nanoseconds = -3 };
/// A time in microseconds from its decimal text, rounded once, or from a date and time of ISO 8601, whatever
/// the unit. Throws Error naming file and line.
std::int64_t time_us(const std::string& file, long line, std::string_view text, TimeUnit unit);

}  // namespace egocal::detail
