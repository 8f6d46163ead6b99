// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <unistd.h>

#include "commands/commands.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/version.hpp"

namespace {

/// A file that a command opens must not take the number of a standard stream that the caller has closed: a
/// warning would be written into it. What cannot be read or written still fails, but for warnings.
void occupy_standard_streams() {
  int fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
  while (fd >= 0 && fd < STDERR_FILENO) fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (fd == STDERR_FILENO) dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  if (fd > STDERR_FILENO) close(fd);
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  egocal::cli::Program program(
      "egocal", "egocal: where sensors sit relative to each other, from their motions alone, with proof",
      egocal::version());
  program.require_subcommand();
  program.footer(
      "Exit codes: 0 success, 1 failure (one line on standard error), 2 wrong usage. Commands that print an "
      "answer: 3 where it should not be used, as it is contradictory or a goal is not reached; of a rig also "
      "where a loop is open or a finding makes a pair doubtful.");
  egocal::tools::add_commands(program);
  return program.run(argc, argv);
}
