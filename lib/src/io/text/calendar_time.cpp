// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/calendar_time.hpp"

#include <chrono>

namespace egocal::detail {

namespace {

/// Takes parts of known width from the beginning of a text; after the first that does not fit, ok is false.
struct Parts {
  std::string_view text;
  bool ok = true;

  int number(std::size_t digits) {
    int value = 0;
    ok = ok && text.size() >= digits;
    for (std::size_t i = 0; ok && i < digits; ++i) {
      ok = text[i] >= '0' && text[i] <= '9';
      value = 10 * value + (text[i] - '0');
    }
    if (ok) text.remove_prefix(digits);
    return value;
  }
  bool optional(char c) {
    const bool here = ok && !text.empty() && text.front() == c;
    if (here) text.remove_prefix(1);
    return here;
  }
  void mark(char c) { ok = optional(c) && ok; }
};

/// Decimals behind the point, rounded to microseconds.
std::int64_t decimals_us(Parts& parts) {
  std::int64_t value = 0;
  int taken = 0;
  while (!parts.text.empty() && parts.text.front() >= '0' && parts.text.front() <= '9') {
    const int digit = parts.text.front() - '0';
    if (taken < 6) value = 10 * value + digit;
    if (taken == 6 && digit >= 5) ++value;
    ++taken;
    parts.text.remove_prefix(1);
  }
  parts.ok = parts.ok && taken > 0;
  for (int i = taken; i < 6; ++i) value *= 10;
  return value;
}

/// Minutes that the zone is ahead of UTC.
int zone_minutes(Parts& parts) {
  if (parts.optional('Z') || parts.text.empty()) return 0;
  const bool ahead = parts.optional('+');
  if (!ahead) parts.mark('-');
  const int hours = parts.number(2);
  parts.optional(':');
  const int minutes = parts.text.empty() ? 0 : parts.number(2);
  parts.ok = parts.ok && hours <= 14 && minutes < 60;
  return (ahead ? 1 : -1) * (60 * hours + minutes);
}

}  // namespace

std::optional<std::int64_t> calendar_time_us(std::string_view text) {
  using namespace std::chrono;
  Parts parts{text};
  const int years = parts.number(4);
  parts.mark('-');
  if (!parts.ok) return {};  // mostly seconds
  const int months = parts.number(2);
  parts.mark('-');
  const int days_of_month = parts.number(2);
  if (!parts.optional('T')) parts.mark(' ');
  const int hour = parts.number(2);
  parts.mark(':');
  const int minute = parts.number(2);
  const int second = parts.optional(':') ? parts.number(2) : 0;
  const std::int64_t fraction = parts.optional('.') || parts.optional(',') ? decimals_us(parts) : 0;
  const int zone = zone_minutes(parts);
  const year_month_day date(year(years), month(static_cast<unsigned>(months)),
                            day(static_cast<unsigned>(days_of_month)));
  // a leap second is the first one of the next minute
  if (!parts.ok || !parts.text.empty() || !date.ok() || hour > 23 || minute > 59 || second > 60) return {};
  const auto whole = sys_days(date) + hours(hour) + minutes(minute - zone) + seconds(second);
  return duration_cast<microseconds>(whole.time_since_epoch()).count() + fraction;
}

}  // namespace egocal::detail
