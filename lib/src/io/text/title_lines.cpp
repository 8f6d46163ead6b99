// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/title_lines.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/text/columns.hpp"
#include "io/text/units.hpp"

namespace egocal::detail {

namespace {

using Fields = std::vector<std::string_view>;

bool any_number(std::string_view field) {
  return is_number(field) || has_decimal_comma(field);
}

/// Whether a line is a row: mostly numbers, or nothing else. Of a pose that was lost there may be a time
/// alone.
bool is_row(const Fields& fields) {
  const auto filled =
      std::count_if(fields.begin(), fields.end(), [](std::string_view field) { return !field.empty(); });
  const auto numbers = std::count_if(fields.begin(), fields.end(), any_number);
  return numbers > 0 && (numbers == filled || (numbers >= 2 && 2 * numbers > filled));
}

/// All columns that have names are there, and hold mostly numbers.
bool is_row_of(const Fields& fields, std::size_t width, const Fields& names) {
  if (width < names.size()) return false;
  std::size_t filled = 0, numbers = 0;
  for (std::size_t i = 0; i < std::min(names.size(), fields.size()); ++i) {
    if (names[i].empty() || names[i] == "-" || fields[i].empty()) continue;
    ++filled;
    if (any_number(fields[i])) ++numbers;
  }
  return numbers > 0 && 2 * numbers > filled;
}

/// The unit behind the field "Length Units", in brackets as names of columns have it.
std::string unit_of_lengths(const Fields& fields) {
  for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
    std::string name, unit;
    for (const char c : fields[i]) name += lower_case(c);
    for (const char c : fields[i + 1]) unit += lower_case(c);
    if (name == "length units" && in_si(Dimension::length, unit)) return " [" + unit + "]";
  }
  return {};
}

bool is_length(const std::string& name) {
  const ColumnMap map = columns_from_names({name});
  return map.has(Quantity::x) || map.has(Quantity::y) || map.has(Quantity::z);
}

}  // namespace

TitleLines title_lines(const Sniffed& sniffed, char separator, const std::string& columns) {
  TitleLines titles;
  Fields names_given;
  if (!columns.empty()) split(columns, ',', names_given);
  std::vector<std::pair<long, Fields>> lines;
  Fields row;
  for (const Line& line : sniffed.data) {
    const std::size_t width = split(line.text, separator, row);
    if (columns.empty() ? is_row(row) : is_row_of(row, width, names_given)) break;
    row.resize(width);
    lines.emplace_back(line.number, row);
  }
  if (lines.size() < 2 || lines.size() == sniffed.data.size()) return titles;
  titles.last = lines.back().first;
  if (!columns.empty()) return titles;
  const std::size_t count = lines.back().second.size();
  if (count < row.size() || count < 3) return titles;
  std::string unit;
  for (const auto& [number, fields] : lines)
    if (unit.empty()) unit = unit_of_lengths(fields);
  for (std::size_t i = 0; i < count; ++i) {
    std::string name;
    for (const auto& [number, fields] : lines)
      // what describes the whole recording has pairs of names and values, and another number of them
      if (fields.size() == count && !fields[i].empty())
        name += (name.empty() ? "" : " ") + std::string(fields[i]);
    std::replace(name.begin(), name.end(), separator, ' ');
    if (!unit.empty() && is_length(name)) name += unit;
    titles.names += (i == 0 ? "" : std::string(1, separator)) + (name.empty() ? "-" : name);
  }
  return titles;
}

void replace_titles(Sniffed& sniffed, const TitleLines& titles, bool named) {
  std::erase_if(sniffed.data, [&](const Line& line) { return line.number <= titles.last; });
  if (named) sniffed.data.insert(sniffed.data.begin(), Line{titles.last, titles.names});
}

}  // namespace egocal::detail
