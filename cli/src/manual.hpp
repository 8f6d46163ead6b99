// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "description.hpp"

namespace egocal::cli {

/// "egocal-log-create.1"
std::string manual_file(const CommandDescription& command);

/// The manual page of one command, for man(1). version: "0.1.0".
std::string manual_page(const CommandDescription& command, const std::string& version);

}  // namespace egocal::cli
