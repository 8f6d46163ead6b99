// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace egocal {

/// Text from a file or a bus for one line on a terminal: valid UTF-8 of at most so many bytes, ending with a
/// whole character. Blanks take the place of control characters, question marks that of what is not UTF-8.
std::string printable(const std::string& text, std::size_t max_length = 200);

}  // namespace egocal
