// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace egocal::fuzz {

/// A promise of what is fuzzed; a broken one is a finding like a crash.
inline void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "promise broken: %s\n", promise);
  std::abort();
}

/// What people get to read when an input is refused.
inline void require_one_line(const std::string& text) {
  require(!text.empty() && text.size() < 1000, "an error is a line that can be read");
  require(std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }),
          "an error has no control characters");
}

}  // namespace egocal::fuzz
