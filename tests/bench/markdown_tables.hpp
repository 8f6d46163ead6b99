// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Tables made by a program, within a page written by people.
#pragma once

#include <string>
#include <vector>

namespace egocal::bench {

struct Table {
  std::string name;                            ///< of its place: <!-- begin NAME --> ... <!-- end NAME -->
  std::vector<std::vector<std::string>> rows;  ///< cells; the first row is the heading
};

/// Exit code of a program that has compared nothing, as it has no data: CTest's SKIP_RETURN_CODE.
inline constexpr int not_compared = 77;

/// "3 of 4".
std::string part(int x, int of);

std::string markdown(const Table& table);

/// The text of a page; empty where there is no such file.
std::string read_page(const std::string& file);

/// The page with the table in its place. Throws std::runtime_error if the page has no such place.
std::string with_table(const std::string& page, const Table& table);

/// The differences between the page and the table, one line each; empty: they agree. Words must be equal;
/// numbers may differ by `relative`, or by one in their last place.
std::vector<std::string> differences(const std::string& page, const Table& table, double relative);

/// The page without the rows whose first cell no row of the table has: a part of a table is compared with it.
std::string with_rows_of(const std::string& page, const Table& table);

/// What a study does with a finished table: prints it, puts it into the page `write`, and compares it with
/// the rows of its own in the page `check`, to 3 %. Empty names: not. Returns the exit code: 1 where a row
/// differs, 2 where the table has none.
int publish(const Table& table, const std::string& write, const std::string& check);

}  // namespace egocal::bench
