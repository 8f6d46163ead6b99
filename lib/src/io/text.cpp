// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "io/text/calendar_time.hpp"

namespace egocal::detail {

namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Splits rows as programs write them: searching for one character takes half of the time.
void split_at_spaces(std::string_view text, std::vector<std::string_view>& fields) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) fields.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// The end of a field that begins with a double quote: after the closing quote. Two quotes stand for one in
/// the text. Without a closing quote it is the beginning: the field is then like any other.
std::size_t behind_quotes(std::string_view text, std::size_t begin) {
  std::size_t at = begin;
  while (at < text.size() && blank(text[at])) ++at;
  if (at == text.size() || text[at] != '"') return begin;
  for (++at; at < text.size(); ++at) {
    if (text[at] != '"') continue;
    if (at + 1 == text.size() || text[at + 1] != '"') return at + 1;
    ++at;
  }
  return begin;
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;  // bytes of a message
  std::string out = "'" + std::string(text.substr(0, most)) + (text.size() > most ? "...'" : "'");
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return out;
}

std::vector<Line> read_lines(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw error_at(file, 0, "", std::string("cannot be opened for reading: ") + std::strerror(errno));
  std::vector<Line> lines;
  std::string text;
  for (long number = 1; std::getline(stream, text); ++number) {
    const auto first = std::find_if_not(text.begin(), text.end(), blank);
    if (first == text.end() || *first == '#') continue;
    lines.push_back({number, text});
  }
  if (stream.bad()) throw error_at(file, 0, "", "reading failed");
  if (lines.empty()) throw error_at(file, 0, "", "holds no data");
  return lines;
}

std::vector<std::string_view> fields(std::string_view text, bool commas) {
  std::vector<std::string_view> result;
  split(text, commas ? ',' : ' ', result);
  return result;
}

std::size_t split(std::string_view text, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = 0;
  if (separator == ' ') {
    if (text.find('\t') == text.npos && text.find('\r') == text.npos) {
      split_at_spaces(text, fields);
      return fields.size();
    }
    while (begin < text.size()) {
      while (begin < text.size() && blank(text[begin])) ++begin;
      std::size_t end = begin;
      while (end < text.size() && !blank(text[end])) ++end;
      if (end > begin) fields.push_back(text.substr(begin, end - begin));
      begin = end;
    }
    return fields.size();
  }
  const auto trimmed = [](std::string_view part) {
    while (!part.empty() && blank(part.front())) part.remove_prefix(1);
    while (!part.empty() && blank(part.back())) part.remove_suffix(1);
    if (part.size() >= 2 && part.front() == '"' && part.back() == '"') part = part.substr(1, part.size() - 2);
    return part;
  };
  const bool quotes = text.find('"') != text.npos;
  while (begin <= text.size()) {
    const std::size_t from = quotes ? behind_quotes(text, begin) : begin;
    const std::size_t end = std::min(text.find(separator, from), text.size());
    fields.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  const std::size_t all = fields.size();
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return all;
}

std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  if (line.find('#') == line.npos) return line;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted && (i == 0 || blank(line[i - 1]))) return line.substr(0, i);
  }
  return line;
}

bool is_missing_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || (text.front() != 'n' && text.front() != 'N')) return false;
  std::string word(text.substr(0, 16));
  for (char& c : word) c = lower_case(c);
  return word == "nan" || word == "none" || word == "null" || word == "na" || word == "n/a" ||
         word.starts_with("nan(");
}

bool parse_number(std::string_view text, double& value) {
  const char* begin = text.data();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool has_decimal_comma(std::string_view text) {
  std::string with_point(text);
  const std::size_t comma = with_point.find(',');
  if (comma == std::string::npos || comma + 1 == with_point.size()) return false;
  with_point[comma] = '.';
  double value = 0;
  return comma > 0 && with_point[comma - 1] >= '0' && with_point[comma - 1] <= '9' &&
         with_point[comma + 1] >= '0' && with_point[comma + 1] <= '9' && parse_number(with_point, value);
}

void throw_not_a_number(const std::string& file, long line, const std::string& field, std::string_view text) {
  double value = 0;
  // a comma within quotes has parted the field
  const bool comma = has_decimal_comma(text) || (text.starts_with('"') && !text.ends_with('"'));
  throw error_at(file, line, field,
                 std::string("expected a ") + (parse_number(text, value) ? "finite " : "") + "number, got " +
                     quoted(text) + (comma ? "; write decimals with a point" : ""));
}

double number(const std::string& file, long line, const std::string& field, std::string_view text) {
  double value = 0;
  if (!parse_number(text, value) || !std::isfinite(value)) throw_not_a_number(file, line, field, text);
  return value;
}

std::int64_t time_us(const std::string& file, long line, std::string_view text, TimeUnit unit) {
  if (const std::optional<std::int64_t> calendar = calendar_time_us(text)) {
    if (!plausible_relative_time(*calendar))
      throw error_at(file, line, "time", "out of range: " + quoted(text));
    return *calendar;
  }
  std::string_view digits = text;
  const bool negative = !digits.empty() && digits.front() == '-';
  if (negative) digits.remove_prefix(1);
  // move the decimal point to microseconds, on the text: a double cannot hold nanoseconds since 1970
  std::int64_t value = 0;
  const auto whole = static_cast<std::ptrdiff_t>(std::min(digits.find('.'), digits.size()));
  std::ptrdiff_t left = whole + static_cast<int>(unit);  // digits still to be taken
  bool decimal = digits.size() > 0 && digits != ".", overflow = false;
  int next_digit = 0;  // behind the last one taken, for rounding
  const auto take = [&](int digit) {
    if (left == 0) next_digit = digit;
    if (left-- <= 0) return;
    overflow = overflow || value > (INT64_MAX - 9) / 10;
    if (!overflow) value = value * 10 + digit;
  };
  for (std::size_t i = 0; i < digits.size() && decimal; ++i) {
    if (static_cast<std::ptrdiff_t>(i) == whole) continue;
    decimal = digits[i] >= '0' && digits[i] <= '9';
    if (decimal) take(digits[i] - '0');
  }
  while (left > 0) take(0);
  if (!decimal) {  // 1.5e9 and the like: as good as a double is
    const double us = number(file, line, "time", text) * std::pow(10.0, static_cast<int>(unit));
    overflow = !(std::abs(us) < 9e18);
    value = overflow ? 0 : std::llround(us);
  } else {
    if (next_digit >= 5) ++value;
    if (negative) value = -value;
  }
  if (overflow || !plausible_relative_time(value))
    throw error_at(file, line, "time", "out of range: " + quoted(text));
  return value;
}

}  // namespace egocal::detail
