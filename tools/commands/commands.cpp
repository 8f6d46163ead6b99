// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/commands.hpp"

#include "commands/compare.hpp"
#include "commands/experiment.hpp"
#include "commands/listen.hpp"

namespace egocal::tools {

void add_commands(cli::App program) {
  add_solve(program);
  add_report(program);
  add_check(program);
  add_simulate(program);
  add_info(program);
  add_align(program);
  add_log(program);
  add_up(program);
  add_listen(program);
  add_tell(program);
  add_export(program);
  add_compare(program);
  add_experiment(program);
}

}  // namespace egocal::tools
