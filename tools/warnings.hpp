// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace egocal::tools {

/// A line on standard error. Nothing fails where it cannot be written: a disk that is full, or a reader that
/// has gone, must not cost the answer. Control characters, which names of files may hold, are not written.
void say(const std::string& line);

/// What a user should know of an answer that is printed all the same: a line each on standard error.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace egocal::tools
