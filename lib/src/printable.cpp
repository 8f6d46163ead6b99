// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/printable.hpp"

#include <algorithm>
#include <string_view>

namespace egocal {

namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// Bytes of the UTF-8 character at the start; 0: there is none.
std::size_t character_length(std::string_view text) {
  const unsigned char first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first <= 0xdf   ? 2
                             : first >= 0xe0 && first <= 0xef ? 3
                             : first >= 0xf0 && first <= 0xf4 ? 4
                                                              : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if (byte_at(text, i) >> 6 != 2) return 0;
  const unsigned char second = byte_at(text, 1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second > 0x9f;
  const bool too_large = first == 0xf4 && second > 0x8f;
  return overlong || surrogate || too_large ? 0 : length;
}

/// Whether a character breaks the line, turns the direction of what follows, or cannot be seen: one text
/// could look like another. Joiners are letters' business, and stay.
bool misleads(std::string_view character) {
  // U+061C; U+200B, E, F; U+2028 to 202E; U+2060 to 206F; U+FEFF
  if (character == "\xd8\x9c" || character == "\xef\xbb\xbf") return true;
  if (character.size() != 3 || byte_at(character, 0) != 0xe2) return false;
  const unsigned char second = byte_at(character, 1), third = byte_at(character, 2);
  if (second == 0x81) return third >= 0xa0 && third <= 0xaf;
  return second == 0x80 &&
         (third == 0x8b || third == 0x8e || third == 0x8f || (third >= 0xa8 && third <= 0xae));
}

}  // namespace

std::string printable(const std::string& text, std::size_t max_length) {
  std::string out;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = character_length(rest);
    if (out.size() + std::max<std::size_t>(length, 1) > max_length) break;
    const unsigned char first = byte_at(rest, 0);
    // C1 control characters are U+0080 to U+009F
    const bool control = first < 0x20 || first == 0x7f || (first == 0xc2 && byte_at(rest, 1) < 0xa0);
    if (length == 0)
      out += '?';
    else if (control || misleads(rest.substr(0, length)))
      out += ' ';
    else
      out += rest.substr(0, length);
    rest.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

}  // namespace egocal
