// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "egocal/error.hpp"

namespace egocal::detail {

namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// What was found in place of something, for one line that can be read.
std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string out = "'" + std::string(text.substr(0, most)) + (text.size() > most ? "...'" : "'");
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return out;
}

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<Line> read_lines(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw error_at(file, 0, "", "cannot be opened for reading");
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
  std::size_t begin = 0;
  const auto trimmed = [](std::string_view part) {
    while (!part.empty() && blank(part.front())) part.remove_prefix(1);
    while (!part.empty() && blank(part.back())) part.remove_suffix(1);
    return part;
  };
  if (commas) {
    while (begin <= text.size()) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      result.push_back(trimmed(text.substr(begin, end - begin)));
      begin = end + 1;
    }
    while (!result.empty() && result.back().empty()) result.pop_back();
    return result;
  }
  while (begin < text.size()) {
    while (begin < text.size() && blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !blank(text[end])) ++end;
    if (end > begin) result.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return result;
}

double number(const std::string& file, long line, const std::string& field, std::string_view text) {
  double value = 0;
  const char* begin = text.data();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw error_at(file, line, field, "expected a number, got " + quoted(text));
  if (!std::isfinite(value))
    throw error_at(file, line, field, "expected a finite number, got " + quoted(text));
  return value;
}

std::int64_t time_us(const std::string& file, long line, std::string_view text, TimeUnit unit) {
  std::string_view digits = text;
  const bool negative = !digits.empty() && digits.front() == '-';
  if (negative) digits.remove_prefix(1);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  std::string whole(digits.substr(0, point));
  std::string fraction(point < digits.size() ? digits.substr(point + 1) : "");
  if (whole.size() + fraction.size() == 0 || !all_digits(whole) || !all_digits(fraction)) {
    // 1.5e9 and the like: as good as a double is
    const double value = number(file, line, "time", text) * (unit == TimeUnit::seconds ? 1e6 : 1e-3);
    if (!(std::abs(value) < 9e18)) throw error_at(file, line, "time", "out of range: " + quoted(text));
    return std::llround(value);
  }
  // move the decimal point to microseconds, on the text
  if (unit == TimeUnit::seconds) {
    fraction.resize(std::max<std::size_t>(fraction.size(), 6), '0');
    whole += fraction.substr(0, 6);
    fraction.erase(0, 6);
  } else {
    whole.insert(0, 3, '0');
    fraction.insert(0, whole.substr(whole.size() - 3));
    whole.erase(whole.size() - 3);
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(whole.data(), whole.data() + whole.size(), value);
  if (whole.size() > 0 && (error != std::errc() || value > std::int64_t{9'000'000'000'000'000'000}))
    throw error_at(file, line, "time", "out of range: " + quoted(text));
  if (!fraction.empty() && fraction.front() >= '5') ++value;
  return negative ? -value : value;
}

}  // namespace egocal::detail
