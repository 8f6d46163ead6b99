// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/layout.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "egocal/error.hpp"
#include "io/text/first_lines.hpp"
#include "io/text/named_columns.hpp"
#include "io/text/rotation_rows.hpp"
#include "io/text/time_columns.hpp"
#include "io/text/title_lines.hpp"

namespace egocal::detail {

namespace {

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

/// Whether four numbers from a field on are a quaternion of length one.
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

/// Lines of titles become one header where they make sense, and are not read where --columns names the
/// columns. Number of the last one; 0: there are none.
long read_titles(TextLayout& layout, Sniffed& sniffed, const ReadOptions& options) {
  const TitleLines titles = title_lines(sniffed, layout.separator, options.columns);
  if (titles.last == 0) return 0;
  std::vector<std::string_view> names;
  split(titles.names, layout.separator, names);
  const bool make_sense = options.columns.empty() && columns_from_names(names).complete();
  if (!make_sense && options.columns.empty()) return 0;
  const std::string lines =
      "lines " + std::to_string(sniffed.data.front().number) + " to " + std::to_string(titles.last);
  layout.notes.push_back(make_sense ? "the names of the columns are those of " + lines
                                    : lines + " are not read: they are before the first row of numbers");
  replace_titles(sniffed, titles, make_sense);
  return titles.last;
}

}  // namespace

TextLayout detect_layout(ByteSource& source, const ReadOptions& options) {
  Sniffed sniffed = sniff(source);
  if (sniffed.data.empty()) throw error_at(source.file(), 0, "", source.why_empty());
  TextLayout layout;
  layout.separator = separator_of(sniffed, options.columns);
  const long titles = layout.separator == ' ' ? 0 : read_titles(layout, sniffed, options);
  layout.decimal_comma = layout.separator != ',' && has_decimal_commas(sniffed, layout.separator);
  if (layout.decimal_comma)
    for (Line& line : sniffed.data)
      if (!is_header(line.text, layout.separator)) std::replace(line.text.begin(), line.text.end(), ',', '.');
  const bool named = set_named(layout, sniffed, options, source.file());
  if (titles > 0) layout.header_line = titles;
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
