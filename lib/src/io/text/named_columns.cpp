// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/named_columns.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "egocal/error.hpp"

namespace egocal::detail {

namespace {

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

}  // namespace

bool is_read(const TextLayout& layout, std::size_t index) {
  return std::any_of(
      layout.columns.of.begin(), layout.columns.of.end(),
      [&](const std::optional<ColumnMap::Column>& column) { return column && column->index == index; });
}

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
                         "; name the columns with --columns t,x,y,z,qx,qy,qz,qw (- for others)");
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

}  // namespace egocal::detail
