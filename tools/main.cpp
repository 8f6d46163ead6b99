// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/commands.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/version.hpp"

int main(int argc, char** argv) {
  egocal::cli::Program program(
      "egocal", "egocal: where sensors sit relative to each other, from their motions alone, with proof",
      egocal::version());
  program.require_subcommand();
  program.footer(
      "Exit codes: 0 success, 1 failure (one line on standard error), 2 wrong usage, 3 an answer was printed "
      "that "
      "should not be used (contradictory, or a goal not reached).");
  egocal::tools::add_commands(program);
  return program.run(argc, argv);
}
