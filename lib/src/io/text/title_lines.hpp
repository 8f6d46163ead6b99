// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Tables whose names take several lines, as motion capture systems write them: the kind of object, its name,
// its quantity ("Rotation"), and its axis ("X"), each in a line of its own above the column, after lines
// about the take.
#pragma once

#include <string>

#include "io/text/first_lines.hpp"

namespace egocal::detail {

/// Lines before the first row of numbers.
struct TitleLines {
  long last = 0;      ///< number of the last one; 0: at most one line is before the rows
  std::string names;  ///< of all columns, from all lines that have as many fields, between separators
};

/// columns: of the option; they tell what a row is.
TitleLines title_lines(const Sniffed& sniffed, char separator, const std::string& columns);

/// Takes the title lines out, and puts the names in as the header where they are wanted.
void replace_titles(Sniffed& sniffed, const TitleLines& titles, bool named);

}  // namespace egocal::detail
