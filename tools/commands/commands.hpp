// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace egocal::tools {

/// Every command of the program; each parses its options and does its work when it is called.
void add_commands(CLI::App& program);

void add_solve(CLI::App& program);
void add_simulate(CLI::App& program);
void add_log(CLI::App& program);
void add_up(CLI::App& program);
void add_tell(CLI::App& program);
void add_export(CLI::App& program);

}  // namespace egocal::tools
