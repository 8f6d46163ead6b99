// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace egocal::tools {

/// What a user should know of an answer that is printed all the same: a line each on standard error.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace egocal::tools
