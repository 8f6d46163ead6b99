// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "egocal/io/recording.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/text.hpp"
#include "io/text/columns.hpp"

namespace egocal::detail {

/// How the rows of a text file are to be read.
struct TextLayout {
  std::string format;          ///< "TUM", "EuRoC csv", "KITTI", "table"
  char separator = ' ';        ///< ' ' for blanks and tabs that merge, '\t', ',' or ';'
  bool decimal_comma = false;  ///< 1,5 between semicolons, blanks or tabs
  long header_line = 0;        ///< that holds names and no data, as all before it; 0: none
  ColumnMap columns;           ///< of formats with columns
  bool named = false;          ///< the columns have names in the file or by --columns: fields may be empty
  bool matrix = false;         ///< rows of a 3 x 4 pose matrix, after a first column where first_column is 1
  std::size_t first_column = 0;
  std::size_t fields = 0;  ///< of a row: exactly this many, or at least where more_fields
  bool more_fields = false;
  bool times = true;   ///< the rows have times of their own
  bool index = false;  ///< the first column is the number of a frame
  TimeUnit unit = TimeUnit::seconds;
  std::vector<std::string> names;  ///< of the first columns, for messages
  std::vector<std::string> notes;  ///< what was assumed
};

/// Limits of times in seconds since 1970 [s]: 1979, before GPS time, and 2100.
inline constexpr double earliest_seconds = 3e8, latest_seconds = 4.1e9;

/// Decides by the first 64 KiB of the file. Throws Error where the file holds no data, is no text, or its
/// columns are not understood.
TextLayout detect_layout(ByteSource& source, const ReadOptions& options);

}  // namespace egocal::detail
