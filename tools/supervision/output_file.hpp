// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::tools {

/// Where the outputs of supervised processes go by default: egocal in the user's folder for states
/// (XDG_STATE_HOME, ~/.local/state), or, where there is no such user's folder, our private folder in /tmp.
/// Throws Error where that one is not private.
std::string default_output_directory();

/// Makes the folder if it does not exist. Throws Error if it is not a folder, or if other users can write to
/// it: in a folder of all users, such as /tmp, it may belong to another user.
void require_private_folder(const std::string& folder);

/// Opens a file for appending, with a line that says when; a file of more than 10 MB becomes FILE.old first.
/// The file descriptor is closed in programs that are executed. Throws Error.
int open_output(const std::string& file);

/// The last line of a file that is not empty, without control characters, at most 200 bytes; empty: none.
std::string last_line(const std::string& file);

}  // namespace egocal::tools
