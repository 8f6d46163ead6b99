// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace egocal {

/// Writes the whole file or nothing: to a temporary one beside it that takes its name in the end. Devices and
/// pipes (/dev/stdout) are written to as they are. Throws Error.
void write_whole_file(const std::string& file, std::string_view content);

}  // namespace egocal
