// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/layout.hpp"
#include "io/text/line_reader.hpp"

namespace egocal::detail {

/// Whether a line holds data: it is neither empty nor a comment.
inline bool is_data(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first != std::string_view::npos && line[first] != '#' && line[first] != '%';
}

/// The rows of the file, one at a time.
struct TextRows {
  TextRows(ByteSource& source, const TextLayout& text_layout) : lines(source), layout(text_layout) {
    if (layout.matrix && layout.times) stamp = 0;
    if (!layout.matrix && layout.columns.has(Quantity::time)) stamp = layout.columns[Quantity::time].index;
  }

  bool next() {
    std::string_view line;
    while (lines.next(line)) {
      if (lines.number() <= layout.header_line || !is_data(line)) continue;
      line = without_comment(line);
      if (layout.decimal_comma) {
        points.assign(line);
        std::replace(points.begin(), points.end(), ',', '.');
        line = points;
      }
      if (layout.separator == ' ' && split_numbers(line)) {
        width = fields.size();
      } else {
        numbers.clear();
        width = split(line, layout.separator, fields);
      }
      ++count;
      return true;
    }
    return false;
  }

  /// split() at blanks of a row of numbers, which are read on the way: a field ends where its number does.
  /// False where one is none.
  bool split_numbers(std::string_view line) {
    fields.clear();
    numbers.clear();
    const char* at = line.data();
    const char* const end = at + line.size();
    while (true) {
      while (at != end && *at == ' ') ++at;
      if (at == end) return true;
      const char* const begin = at;
      double number = 0;
      if (fields.size() == stamp) {
        while (at != end && *at != ' ' && *at != '\t' && *at != '\r') ++at;
      } else {
        const auto [behind, error] = std::from_chars(begin, end, number);
        if (error != std::errc() || !std::isfinite(number)) return false;
        at = behind;
      }
      if (at != end && *at != ' ') return false;
      fields.emplace_back(begin, static_cast<std::size_t>(at - begin));
      numbers.push_back(number);
    }
  }

  /// The finite number in this field, which is there.
  std::optional<double> number(std::size_t index) const {
    double value = 0;
    if (index < numbers.size() && index != stamp) return numbers[index];
    if (!parse_number(fields[index], value) || !std::isfinite(value)) return std::nullopt;
    return value;
  }

  /// Whether a field that is read has no number, because tracking was lost.
  bool without_a_number() const {
    const auto missing = [&](std::size_t i) { return i < fields.size() && is_missing_number(fields[i]); };
    if (!numbers.empty()) return missing(stamp);  // the other fields are numbers
    if (layout.matrix) {
      for (std::size_t i = 0; i < fields.size(); ++i)
        if (missing(i)) return true;
      return false;
    }
    return std::any_of(layout.columns.of.begin(), layout.columns.of.end(),
                       [&](const auto& column) { return column && missing(column->index); });
  }

  LineReader lines;
  const TextLayout& layout;
  std::vector<std::string_view> fields;
  std::vector<double> numbers;   ///< of the fields; empty where they are not all numbers
  std::size_t stamp = SIZE_MAX;  ///< field that is read as text, for a double cannot hold nanoseconds
  std::string points;
  std::size_t count = 0;  ///< rows so far
  std::size_t width = 0;  ///< fields of this row, empty ones at its end included
};

}  // namespace egocal::detail
