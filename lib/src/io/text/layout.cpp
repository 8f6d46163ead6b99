// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "egocal/error.hpp"
#include "io/text/first_lines.hpp"
#include "io/text/rotation_rows.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Times above it are no seconds since 1970 [s]: 2100.
constexpr double latest_seconds = 4.1e9;

/// The header's names, of which those of a quantity become columns.
std::vector<std::string_view> name_columns(TextLayout& layout, std::string_view header) {
  std::vector<std::string_view> names;
  split(header, layout.separator, names);
  layout.columns = columns_from_names(names);
  layout.names.assign(names.begin(), names.end());
  return names;
}

/// Refuses a unit that is not known, and a name that two columns share. line: of the header; 0: the names are
/// those of --columns.
void check_columns(const std::vector<std::string_view>& names, const ColumnMap& columns,
                   const std::string& file, long line) {
  const auto refused = [&](std::size_t index, const std::string& problem) {
    const std::string name(names[index].substr(0, 100));
    return error_at(
        file, line,
        line > 0 ? "column " + std::to_string(index + 1) + " (" + name + ")" : "--columns: '" + name + "'",
        problem);
  };
  for (std::size_t i = 0; i < quantities; ++i) {
    if (!columns.of[i]) continue;
    const ColumnMap::Column& column = *columns.of[i];
    for (std::size_t k = column.index + 1; k < names.size(); ++k)
      if (same_name(names[k], names[column.index]))
        throw refused(k,
                      "is the name of column " + std::to_string(column.index + 1) + " as well; " +
                          (line > 0 ? "name the one that counts with --columns t,x,y,z,qx,qy,qz,qw, others -"
                                    : "a column that does not count is -"));
    if (column.unit.empty() || column.in_si) continue;
    const Dimension dimension = dimension_of(static_cast<Quantity>(i));
    throw refused(column.index, "the unit '" + column.unit.substr(0, 40) + "' is not known; expected " +
                                    known_units(dimension) + ": convert the column" +
                                    (line > 0 ? ", or name the columns with --columns" : ""));
  }
}

/// Notes columns with the same meaning as a chosen one, such as those of a second robot.
void note_rivals(TextLayout& layout) {
  std::string text;
  for (std::size_t i = 0; i < quantities; ++i)
    if (layout.columns.of[i] && layout.columns.of[i]->rival)
      text += (text.empty() ? "" : ", ") + layout.names[layout.columns.of[i]->index] + " (not " +
              layout.names[*layout.columns.of[i]->rival] + ")";
  if (!text.empty())
    layout.notes.push_back("the first of similar columns are taken: " + text + "; --columns names others");
  if (!layout.columns.other_time) return;
  const bool parts = layout.columns.has(Quantity::seconds);
  const std::size_t time = layout.columns[parts ? Quantity::seconds : Quantity::time].index;
  layout.notes.push_back(
      "the times are those of " + layout.names[time] +
      (parts ? " and " + layout.names[layout.columns[Quantity::nanoseconds].index] : std::string()) +
      ", not " + layout.names[*layout.columns.other_time] + "; --columns names others");
}

/// Whether a quantity is in the column at `index`.
bool is_read(const TextLayout& layout, std::size_t index) {
  return std::any_of(
      layout.columns.of.begin(), layout.columns.of.end(),
      [&](const std::optional<ColumnMap::Column>& column) { return column && column->index == index; });
}

/// Notes a name of --columns that is no quantity, as it may be misspelt.
void note_unread(TextLayout& layout) {
  std::string text;
  for (std::size_t k = 0; k < layout.names.size(); ++k) {
    if (layout.names[k].empty() || layout.names[k] == "-") continue;
    if (!is_read(layout, k)) text += (text.empty() ? "" : ", ") + quoted(layout.names[k]);
  }
  if (!text.empty()) layout.notes.push_back("not read of --columns: " + text + " (- for what is not needed)");
}

/// Fields behind the last name of --columns may be what was meant: "t,x,y,z,yaw" takes a quaternion's x.
void note_unnamed(TextLayout& layout, std::size_t fields) {
  if (fields > layout.names.size())
    layout.notes.push_back("--columns names " + std::to_string(layout.names.size()) + " of " +
                           std::to_string(fields) +
                           " fields in a row: those behind are not read (- for what is not needed)");
}

/// What EuRoC's files hold, whatever their header calls it.
bool is_euroc(const TextLayout& layout, const std::vector<std::string_view>& row) {
  using enum Quantity;
  constexpr Quantity order[] = {time, x, y, z, qw, qx, qy, qz};
  for (std::size_t i = 0; i < std::size(order); ++i)
    if (!layout.columns.has(order[i]) || layout.columns[order[i]].index != i) return false;
  double first = 0;
  return layout.separator == ',' && parse_number(row[0], first) && std::abs(first) >= latest_seconds;
}

/// The columns of a format without a header.
void set_columns(TextLayout& layout, std::initializer_list<std::pair<const char*, Quantity>> columns) {
  std::size_t index = 0;
  for (const auto& [label, quantity] : columns) {
    layout.columns.set(quantity, index++);
    layout.names.emplace_back(label);
  }
}

void set_tum(TextLayout& layout) {
  using enum Quantity;
  set_columns(
      layout,
      {{"time", time}, {"tx", x}, {"ty", y}, {"tz", z}, {"qx", qx}, {"qy", qy}, {"qz", qz}, {"qw", qw}});
  layout.format = "TUM";
  layout.fields = 8;
}

/// Four numbers from a field on, as a quaternion of length one.
bool is_unit_quaternion(const std::vector<std::string_view>& row, std::size_t first) {
  double square = 0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double value = 0;
    if (!parse_number(row[i], value)) return false;
    square += value * value;
  }
  return std::abs(square - 1) < 0.01;
}

/// Seven numbers a row and no time: a position and a quaternion of length one, x y z w.
bool set_untimed(TextLayout& layout, const std::vector<std::string_view>& row) {
  using enum Quantity;
  if (row.size() != 7 || !is_unit_quaternion(row, 3)) return false;
  set_columns(layout, {{"tx", x}, {"ty", y}, {"tz", z}, {"qx", qx}, {"qy", qy}, {"qz", qz}, {"qw", qw}});
  layout.format = "TUM without times";
  layout.fields = 7;
  layout.times = false;
  layout.notes.push_back("no header: columns are taken as x y z qx qy qz qw (name others with --columns)");
  return true;
}

void set_euroc(TextLayout& layout) {
  using enum Quantity;
  set_columns(
      layout,
      {{"time[ns]", time}, {"x", x}, {"y", y}, {"z", z}, {"qw", qw}, {"qx", qx}, {"qy", qy}, {"qz", qz}});
  layout.format = "EuRoC csv";
  layout.fields = 8;
  layout.more_fields = true;
}

/// What `ros2 topic echo --csv` writes of a stamped pose, transform or odometry: seconds, nanoseconds, one or
/// two names of frames, position, quaternion x y z w, and perhaps a covariance and a velocity.
bool set_ros2_csv(TextLayout& layout, const std::vector<std::string_view>& row) {
  using enum Quantity;
  if (layout.separator != ',' || row.size() < 10 || !is_number(row[0]) || !is_number(row[1]) ||
      is_number(row[2]))
    return false;
  const std::size_t first = is_number(row[3]) ? 3 : 4;
  if (row.size() < first + 7 || !is_unit_quaternion(row, first + 3)) return false;
  for (std::size_t i = first; i < first + 3; ++i)
    if (!is_number(row[i])) return false;
  layout.columns.set(seconds, 0);
  layout.columns.set(nanoseconds, 1);
  constexpr Quantity pose[] = {x, y, z, qx, qy, qz, qw};
  for (std::size_t i = 0; i < std::size(pose); ++i) layout.columns.set(pose[i], first + i);
  layout.names = {"sec", "nanosec", "frame_id"};
  if (first == 4) layout.names.emplace_back("child_frame_id");
  for (const char* name : {"x", "y", "z", "qx", "qy", "qz", "qw"}) layout.names.emplace_back(name);
  layout.format = "ROS 2 csv";
  layout.fields = first + 7;
  layout.more_fields = true;
  return true;
}

/// A table whose columns have names, from the option or a header.
bool set_named(TextLayout& layout, const Sniffed& sniffed, const ReadOptions& options,
               const std::string& file) {
  const bool header = is_header(sniffed.data.front().text, layout.separator);
  if (header) layout.header_line = sniffed.data.front().number;
  bool euroc = false;
  if (!options.columns.empty()) {
    TextLayout named;
    named.separator = ',';
    const std::vector<std::string_view> names = name_columns(named, options.columns);
    if (!named.columns.complete())
      throw error_at(file, 0, "--columns", named.columns.missing() + " among '" + options.columns + "'");
    check_columns(names, named.columns, file, 0);
    layout.columns = named.columns;
    layout.names = named.names;
    note_unread(layout);
    std::vector<std::string_view> row;
    split(first_whole_row(sniffed, layout.separator).text, layout.separator, row);
    note_unnamed(layout, row.size());
  } else if (header) {
    const std::vector<std::string_view> names = name_columns(layout, sniffed.data.front().text);
    if (!layout.columns.complete())
      throw error_at(file, layout.header_line, "",
                     "the header names " + layout.columns.missing() +
                         "; name the columns with --columns t,x,y,z,qx,qy,qz,qw");
    check_columns(names, layout.columns, file, layout.header_line);
    note_rivals(layout);
  } else {
    // a header in a comment is taken where it makes sense
    std::vector<std::string_view> row;
    const std::size_t width = split(sniffed.data.front().text, layout.separator, row);
    for (const Line& comment : sniffed.comments) {
      TextLayout named;
      named.separator = layout.separator;
      const std::vector<std::string_view> names =
          name_columns(named, std::string_view(comment.text).substr(comment.text.find_first_of("#%") + 1));
      if (!named.columns.complete() || !named.columns.has_time()) continue;
      if (named.names.size() != row.size() && named.names.size() != width) continue;
      check_columns(names, named.columns, file, comment.number);
      layout.columns = named.columns;
      layout.names = named.names;
    }
    if (!layout.columns.complete()) return false;
    note_rivals(layout);
    euroc = is_euroc(layout, row);
  }
  layout.format = euroc ? "EuRoC csv" : "table";
  layout.named = true;
  layout.fields = layout.columns.width();
  layout.more_fields = true;
  layout.times = layout.columns.has_time();
  return true;
}

/// Rows of a pose matrix: 12 numbers (3 x 4) or 16 (4 x 4), with the time or number of the frame before them
/// or not.
bool set_matrix(TextLayout& layout, const std::vector<std::string_view>& row) {
  const std::size_t n = row.size();
  if (n != 12 && n != 13 && n != 16 && n != 17) return false;
  const std::size_t first = n % 4 == 1 ? 1 : 0;
  if (n != 12 && !looks_like_pose_matrix(row, first)) return false;
  layout.format = "KITTI";
  layout.matrix = true;
  layout.first_column = first;
  layout.fields = n;
  layout.times = first == 1;
  layout.names.clear();
  return true;
}

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

/// A column without a known name whose values increase from row to row may hold the times. Numbers of rows do
/// as well, by one.
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

struct TimeUnitName {
  TimeUnit unit;
  const char* name;
  double in_seconds;
};
constexpr TimeUnitName time_units[] = {{TimeUnit::seconds, "seconds", 1},
                                       {TimeUnit::milliseconds, "milliseconds", 1e-3},
                                       {TimeUnit::microseconds, "microseconds", 1e-6},
                                       {TimeUnit::nanoseconds, "nanoseconds", 1e-9}};

const TimeUnitName& unit_by_size(std::vector<double> times) {
  constexpr double earliest = 3e8, latest = 2.5e9;  // limits of dates [s]: 1979, before GPS time, and 2049
  // limit [s]: no sensor that is worth calibrating sends a pose every ten seconds and less often
  constexpr double longest_step = 10;
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
    if (size * unit.in_seconds >= earliest && size * unit.in_seconds <= latest &&
        typical_step * unit.in_seconds < longest_step)
      return unit;
  // any other time: the unit that puts the step next to 0.06 s, in the middle of 1 kHz and 1 Hz, is the
  // likely one
  if (!(typical_step >= longest_step)) return time_units[0];
  const TimeUnitName* best = &time_units[0];
  for (const TimeUnitName& unit : time_units)
    if (std::abs(std::log(typical_step * unit.in_seconds / 0.06)) <
        std::abs(std::log(typical_step * best->in_seconds / 0.06)))
      best = &unit;
  return *best;
}

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

}  // namespace

TextLayout detect_layout(ByteSource& source, const ReadOptions& options) {
  Sniffed sniffed = sniff(source);
  if (sniffed.data.empty()) throw error_at(source.file(), 0, "", "holds no data");
  TextLayout layout;
  layout.separator = separator_of(sniffed, options.columns);
  layout.decimal_comma = layout.separator != ',' && has_decimal_commas(sniffed, layout.separator);
  if (layout.decimal_comma)
    for (Line& line : sniffed.data)
      if (!is_header(line.text, layout.separator)) std::replace(line.text.begin(), line.text.end(), ',', '.');
  const bool named = set_named(layout, sniffed, options, source.file());
  if (!named && layout.separator == '\t') layout.separator = ' ';
  std::vector<std::string_view> row;
  split(first_whole_row(sniffed, layout.separator).text, layout.separator, row);
  if (!named && !set_ros2_csv(layout, row) && !set_matrix(layout, row) && !set_untimed(layout, row)) {
    if (layout.separator == ' ') {
      set_tum(layout);
    } else {
      // with commas: EuRoC's nanoseconds go with w first, seconds with TUM's w last
      double first = 0;
      if (!row.empty()) parse_number(row[0], first);
      const bool seconds = row.size() == 8 && std::abs(first) < latest_seconds;
      seconds ? set_tum(layout) : set_euroc(layout);
      if (seconds)
        layout.notes.push_back(
            "no header: columns are taken as time x y z qx qy qz qw (name others with --columns)");
    }
  }
  if (layout.times) set_time_unit(layout, sniffed);
  if (!layout.times && layout.named && options.columns.empty()) note_likely_times(layout, sniffed);
  return layout;
}

}  // namespace egocal::detail
