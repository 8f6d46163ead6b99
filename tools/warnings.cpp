// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "warnings.hpp"

#include <cstdio>

namespace egocal::tools {

void say(const std::string& line) {
  std::string text = line;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\n' ? ' ' : '?';
  text += '\n';
  std::fwrite(text.data(), 1, text.size(), stderr);  // in one piece, as standard error is not buffered
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) say("egocal: warning: " + warning);
}

}  // namespace egocal::tools
