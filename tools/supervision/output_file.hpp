// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::tools {

/// Where the outputs of supervised processes go by default: egocal in the user's folder for states
/// (XDG_STATE_HOME, ~/.local/state), or in /tmp.
std::string default_output_directory();

/// Opens it for appending, with a line that says when; one of more than 10 MB becomes FILE.old first. The
/// file descriptor is closed in programs that are executed. Throws Error.
int open_output(const std::string& file);

/// The last line of a file that is not empty, without control characters, at most 200 bytes; empty: none.
std::string last_line(const std::string& file);

}  // namespace egocal::tools
