// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "commands/request_options.hpp"

namespace egocal::tools {

/// What `egocal solve` takes for three sensors and more, as typed.
struct RigOptionsTyped {
  std::vector<std::string> more;  ///< after A and B
  std::string rig;
  std::vector<std::string> from;  ///< NAME=FILE
};

void add_rig_options(cli::App command, RigOptionsTyped& options);

/// Whether a rig is asked for.
bool is_rig(const RigOptionsTyped& options);

/// What goes with all of `solve`.
struct RigOutput {
  bool json = false;
  std::string format, out;
  std::string command_line;
};

/// Solves and prints. Throws UsageError where an option of two sensors was given.
void solve_rig_command(const RequestOptions& typed, const RigOptionsTyped& rig, const RigOutput& output);

}  // namespace egocal::tools
