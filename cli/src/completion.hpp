// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "description.hpp"

namespace egocal::cli {

/// Scripts that complete commands, options and their values; everything else is completed as a file.
std::string bash_completion(const CommandDescription& program);
std::string zsh_completion(const CommandDescription& program);
std::string fish_completion(const CommandDescription& program);

}  // namespace egocal::cli
