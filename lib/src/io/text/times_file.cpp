// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/times_file.hpp"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/error.hpp"
#include "io/text/calendar_time.hpp"
#include "io/text/layout.hpp"
#include "io/text/text_rows.hpp"

namespace egocal::detail {

namespace {

/// What a time that is too large for seconds may be, and the cure; empty: anything.
std::string in_other_unit(double size) {
  if (size >= 1e3 * earliest_seconds && size <= 1e3 * latest_seconds)
    return ", as large as milliseconds since 1970: divide the times by 1000";
  if (size >= 1e6 * earliest_seconds && size <= 1e6 * latest_seconds)
    return ", as large as microseconds since 1970: divide the times by 1000000";
  return ": give the times in seconds";
}

}  // namespace

namespace {

std::vector<std::int64_t> read_times(ByteSource& source) {
  const std::string& file = source.file();
  LineReader lines(source);
  std::string_view line;
  std::vector<std::string_view> fields;
  std::vector<std::int64_t> times;
  while (lines.next(line)) {
    if (!is_data(line)) continue;
    split(without_comment(line), ' ', fields);
    std::string_view text = fields[0];
    if (fields.size() == 2) {  // "2011-09-26 13:02:25.964389445"
      text = {fields[0].data(), static_cast<std::size_t>(fields[1].end() - fields[0].begin())};
      if (!calendar_time_us(text)) text = {};
    }
    if (fields.size() > 2 || text.empty())
      throw error_at(file, lines.number(), "",
                     "expected one time, got " + std::to_string(fields.size()) + " fields");
    double size = 0;
    const bool is_number = parse_number(text, size);
    // larger than dates in microseconds
    const bool epoch_ns = is_number && std::abs(size) > 1e6 * latest_seconds;
    if (is_number && !epoch_ns && std::abs(size) > latest_seconds)
      throw error_at(
          file, lines.number(), "time",
          "expected seconds, or nanoseconds since 1970, got " + quoted(text) + in_other_unit(std::abs(size)));
    times.push_back(
        time_us(file, lines.number(), text, epoch_ns ? TimeUnit::nanoseconds : TimeUnit::seconds));
  }
  if (times.empty()) throw error_at(file, 0, "", source.why_empty());
  return times;
}

}  // namespace

std::vector<std::int64_t> read_times_file(const std::string& file) {
  ByteSource source(file);
  std::vector<std::int64_t> times;
  source.read_content([&] { times = read_times(source); });
  return times;
}

}  // namespace egocal::detail
