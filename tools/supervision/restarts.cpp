// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/restarts.hpp"

#include <algorithm>

namespace egocal::tools {

Restarts::Next Restarts::ended(const Program& program, int exit_code, std::chrono::milliseconds lived) {
  if (exit_code == 0 && (program.ends_all || program.foreground)) return Next::finished;
  started_well_ = started_well_ || lived >= options_.started_well;
  // the person in front of a foreground program sees why it failed
  const bool seen = program.foreground && exit_code > 0;
  if ((exit_code == wrong_usage || exit_code == exec_failed || seen) && !started_well_) return Next::hopeless;
  pause_after(lived);
  return Next::again;
}

void Restarts::pause_after(std::chrono::milliseconds lived) {
  const bool soon = lived < options_.started_well;
  pause_ =
      soon && pause_.count() > 0 ? std::min(2 * pause_, options_.longest_back_off) : options_.first_back_off;
}

}  // namespace egocal::tools
