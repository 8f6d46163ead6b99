// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/bytes/byte_source.hpp"
#include "io/text.hpp"

namespace egocal::detail {

/// The first lines of a file.
struct Sniffed {
  std::vector<Line> comments;  ///< before the first data
  std::vector<Line> data;      ///< the first may be a header
};

/// The lines of the first 64 KiB. Throws Error where the file is no text, or text of another kind.
Sniffed sniff(ByteSource& source);

/// The character between the fields: ' ' for blanks and tabs that merge, '\t', ',' or ';'. columns: of the
/// option.
char separator_of(const Sniffed& sniffed, const std::string& columns);

/// Whether a line has names instead of numbers: the first field is a word, and so are most of the others.
bool is_header(std::string_view line, char separator);

/// Whether the numbers have decimal commas, in a file that has no decimal point.
bool has_decimal_commas(const Sniffed& sniffed, char separator);

bool is_number(std::string_view text);

/// The first row whose fields all are there: one without a pose does not tell the format.
const Line& first_whole_row(const Sniffed& sniffed, char separator);

}  // namespace egocal::detail
