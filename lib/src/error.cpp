// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/error.hpp"

namespace egocal {

Error error_at(const std::string& file, long line, const std::string& field, const std::string& problem) {
  std::string text = file;
  if (line > 0) text += (text.empty() ? "line " : ":") + std::to_string(line);
  if (!text.empty()) text += ": ";
  if (!field.empty()) text += field + ": ";
  text += problem;
  // what is quoted from a file may hold anything, and one line is promised
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  constexpr std::size_t longest_line = 900;  // a terminal's worth; the place and the cause come first
  if (text.size() > longest_line) text = text.substr(0, longest_line) + "...";
  return Error(text);
}

}  // namespace egocal
