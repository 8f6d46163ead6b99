// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/times_file.hpp"

#include <cmath>

#include "egocal/error.hpp"
#include "io/text/calendar_time.hpp"
#include "io/text/text_rows.hpp"

namespace egocal::detail {

std::vector<std::int64_t> read_times_file(const std::string& file) {
  ByteSource source(file);
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
    const bool epoch_ns = parse_number(text, size) && std::abs(size) > 4.1e15;
    times.push_back(
        time_us(file, lines.number(), text, epoch_ns ? TimeUnit::nanoseconds : TimeUnit::seconds));
  }
  if (times.empty()) throw error_at(file, 0, "", source.why_empty());
  return times;
}

}  // namespace egocal::detail
