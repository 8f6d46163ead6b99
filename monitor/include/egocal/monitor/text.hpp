// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace egocal::monitor {

/// What the terminal can show. ascii: one byte a cell, for the C locale and consoles without braille.
enum class Charset { ascii, unicode };

/// The words of the drawing that differ between character sets.
struct Symbols {
  const char* arrow;
  const char* plus_minus;
  const char* degree;
  const char* micro;
  const char* yes;
  const char* no;
  const char* alive;
  const char* gone;
  const char* cursor;
  const char* dot;   ///< between items of a line
  const char* line;  ///< horizontal
  const char* bar_full;
  const char* bar_empty;
  const char* infinite;
};
const Symbols& symbols(Charset charset);

/// Text from outside (names, errors) made fit for one line of any terminal: valid, printable characters of
/// width one, everything else (control characters, escapes, broken UTF-8, wide and combining ones) becomes
/// '?'; cut to max characters, with the cut marked by "~".
std::string clean(std::string_view text, std::size_t max = 60);
/// The same for a name among others that begin alike: cut in the middle, "radar_~ange".
std::string clean_name(std::string_view name, std::size_t max);
/// The text in lines of at most max cells, cut at blanks where there are any; lines after the first begin
/// with the indent.
std::vector<std::string> wrapped(std::string_view text, std::size_t max, std::size_t indent);
/// Where a text is wider than this, its paths lose their folders, from the first one on: what is wrong with a
/// file is behind its name ("~/pairing.state: cannot be written").
std::string without_folders(std::string_view text, std::size_t max);

/// The size of a screen [cells].
struct Size {
  int width = 0, height = 0;
};
/// "100x30", each from 1 to 1000; empty where it is anything else.
std::optional<Size> size_from_text(const std::string& text);

/// Decodes UTF-8; broken bytes become '?'.
std::u32string decode(std::string_view text);
void append_utf8(std::string& text, char32_t glyph);

/// Cells that a text takes; all our text is of width one a character.
int width_of(std::string_view text);
/// Filled with blanks, or cut, to exactly this many cells.
std::string pad_right(std::string_view text, int width);
std::string pad_left(std::string_view text, int width);

/// "12.34", "-" for NaN, "inf" for infinity; numbers too large for people in scientific notation. Never
/// "-0.00".
std::string number(double value, int decimals, Charset charset);
/// Three significant digits or so: "0.0123", "1.2e-09".
std::string compact(double value, Charset charset);
/// "5.2 us", "310 us", "1.4 ms", "2.0 s"; "-" for negative.
std::string duration(double seconds, Charset charset);
/// "now", "3 s", "5 min", "2 h": an age.
std::string age(double seconds);
/// "1234", "12.3k", "4.5M".
std::string count(std::int64_t value);
/// "hh:mm:ss" of a wall clock, shifted by the zone's offset.
std::string clock_time(std::int64_t wall_us, int utc_offset_s);

}  // namespace egocal::monitor
