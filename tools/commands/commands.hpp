// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"

namespace egocal::tools {

/// Every command of the program; each parses its options and does its work when it is called.
void add_commands(cli::App program);

void add_solve(cli::App program);
void add_report(cli::App program);
void add_check(cli::App program);
void add_simulate(cli::App program);
void add_log(cli::App program);
void add_info(cli::App program);
void add_align(cli::App program);
void add_up(cli::App program);
void add_tell(cli::App program);
void add_export(cli::App program);

}  // namespace egocal::tools
