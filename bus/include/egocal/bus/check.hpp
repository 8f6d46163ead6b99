// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What must be true whatever arrives. Input from outside is never checked with this: it is rejected and
// counted.
#pragma once

namespace egocal::bus {

/// Throws std::logic_error (no Error: that is for bad input, and handled as such) with one line that names
/// what is not true and where. Programs print it and end with 1; their supervisor starts them again, from
/// what they had saved before.
[[noreturn]] void contradiction(const char* what, const char* file, long line);

}  // namespace egocal::bus

/// Kept in every build: one comparison of what is at hand. what: a sentence that is true when all is well.
#define EGOCAL_CHECK(condition, what) \
  (static_cast<bool>(condition) ? void() : ::egocal::bus::contradiction(what, __FILE__, __LINE__))
