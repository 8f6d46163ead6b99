// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/time_columns.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/statistics/median.hpp"
#include "io/text/named_columns.hpp"

namespace egocal::detail {

namespace {

/// Times in the first rows, as numbers.
std::vector<double> sniffed_times(const TextLayout& layout, const Sniffed& sniffed, std::size_t column) {
  std::vector<double> times;
  std::vector<std::string_view> row;
  for (const Line& line : sniffed.data) {
    if (line.number == layout.header_line) continue;
    split(line.text, layout.separator, row);
    double value = 0;
    if (column < row.size() && parse_number(row[column], value) && std::isfinite(value))
      times.push_back(value);
  }
  return times;
}

struct TimeUnitName {
  TimeUnit unit;
  const char* name;
  double in_seconds;
};
constexpr TimeUnitName time_units[] = {{TimeUnit::seconds, "seconds", 1},
                                       {TimeUnit::milliseconds, "milliseconds", 1e-3},
                                       {TimeUnit::microseconds, "microseconds", 1e-6},
                                       {TimeUnit::nanoseconds, "nanoseconds", 1e-9}};

/// Limits of the times of poses. The cases are those of tests/lib/test_io_table_times.cpp.
struct TimeLimits {
  double earliest = earliest_seconds, latest = 2.5e9;  ///< of dates [s]: 1979 and 2049
  /// No sensor that is worth calibrating sends a pose every ten seconds and less often [s].
  double longest_step = 10;
  /// Still poses do come as rarely. Files of at most this many rows may hold them, with dates from 2000 on
  /// and up to an hour [s] between two. Open: a stream of as few poses at 0.3 to 100 Hz, with times in the
  /// next smaller unit since a machine was switched on 11 to 29 days ago, has the same numbers. It is taken
  /// for dates; its poses are then too far apart to be interpolated, and that is an error.
  std::size_t most_still = 200;
  double earliest_still = 946'684'800, longest_still = 3600;
};

const TimeUnitName& unit_by_size(std::vector<double> times, const TimeLimits& limits = {}) {
  // rows may be out of order: the steps are those of the times in order
  std::sort(times.begin(), times.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const double typical_step = steps.empty() ? 0 : median(steps);
  // nanoseconds since a phone was switched on may look like milliseconds since 1970, but for their steps
  std::vector<double> sizes;
  for (const double time : times) sizes.push_back(std::abs(time));
  const double size = sizes.empty() ? 0 : median(sizes);  // a single wrong time does not decide
  for (const TimeUnitName& unit : time_units)
    if (size * unit.in_seconds >= limits.earliest && size * unit.in_seconds <= limits.latest &&
        typical_step * unit.in_seconds < limits.longest_step)
      return unit;
  for (const TimeUnitName& unit : time_units)
    if (times.size() <= limits.most_still && size * unit.in_seconds >= limits.earliest_still &&
        size * unit.in_seconds <= limits.latest && typical_step * unit.in_seconds <= limits.longest_still)
      return unit;
  // any other time: the unit that puts the step next to 0.06 s, in the middle of 1 kHz and 1 Hz, is the
  // likely one
  if (!(typical_step >= limits.longest_step)) return time_units[0];
  const TimeUnitName* best = &time_units[0];
  for (const TimeUnitName& unit : time_units)
    if (std::abs(std::log(typical_step * unit.in_seconds / 0.06)) <
        std::abs(std::log(typical_step * best->in_seconds / 0.06)))
      best = &unit;
  return *best;
}

}  // namespace

void set_time_unit(TextLayout& layout, const Sniffed& sniffed) {
  if (layout.columns.has(Quantity::seconds) && !layout.matrix) return;
  const std::size_t column = layout.matrix ? 0 : layout.columns[Quantity::time].index;
  const std::vector<double> times = sniffed_times(layout, sniffed, column);
  if (layout.matrix) {  // numbers of frames are whole, begin small and do not leap
    layout.index = !times.empty() && times.front() < 1e6 && times.back() < 1e7;
    for (const double time : times) layout.index = layout.index && time == std::floor(time);
    layout.times = !layout.index;
    if (layout.index) return;
  }
  for (const TimeUnitName& unit : time_units)
    if (!layout.matrix && layout.columns[Quantity::time].in_si == unit.in_seconds) {
      layout.unit = unit.unit;
      return;
    }
  const TimeUnitName& unit = unit_by_size(times);
  layout.unit = unit.unit;
  const bool usual = layout.format == "EuRoC csv" ? unit.unit == TimeUnit::nanoseconds : unit.in_seconds == 1;
  if (!usual) layout.notes.push_back(std::string("times are taken as ") + unit.name + ", by their size");
}

void note_likely_times(TextLayout& layout, const Sniffed& sniffed) {
  if (layout.header_line == 0) return;
  for (std::size_t k = 0; k < layout.names.size(); ++k) {
    if (is_read(layout, k)) continue;
    const std::vector<double> values = sniffed_times(layout, sniffed, k);
    bool increases = values.size() > 2 && values.size() + 1 == sniffed.data.size(), counts = true;
    for (std::size_t i = 1; i < values.size(); ++i) {
      increases = increases && values[i] > values[i - 1];
      counts = counts && values[i] == values[i - 1] + 1;
    }
    if (!increases || counts) continue;
    layout.notes.push_back("column " + std::to_string(k + 1) + " (" + layout.names[k].substr(0, 100) +
                           ") increases as times do; where it holds them, call it t: --columns t,x,y,z,...");
    return;
  }
}

}  // namespace egocal::detail
