// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// The characters that end the lines of a text, from its beginning on: LF (also CR LF); CR where there is no
/// LF; either where more lines end by a CR than by an LF: a header was put above rows that end by CR.
std::string_view line_ends_of(ByteSource& source);

/// The first line of a text. Without an end, `whole` is its size.
struct LineSize {
  std::size_t size = 0, whole = 0;  ///< [bytes] without and with the end, which may be CR LF
  bool terminated = false;
};
LineSize first_line(std::string_view text, std::string_view line_ends);

/// Reads the lines of a text file one at a time, without copying them. A byte order mark and line ends are
/// removed.
class LineReader {
 public:
  explicit LineReader(ByteSource& source) : source_(source) {}

  /// Reads the next line; false at the end. The line is valid until the next call. Throws Error for a line
  /// above 1 MiB, which no text has.
  bool next(std::string_view& line);
  long number() const { return number_; }          ///< of the line handed out last, from 1
  bool terminated() const { return terminated_; }  ///< it had a line end

 private:
  ByteSource& source_;
  std::size_t pending_ = 0;  ///< bytes of the line handed out last
  long number_ = 0;
  std::string_view line_ends_;
  bool terminated_ = true;
};

}  // namespace egocal::detail
