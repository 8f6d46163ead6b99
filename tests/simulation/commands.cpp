// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/commands.hpp"

#include "egocal/bus/channels.hpp"

namespace egocal::simulation {

void Commands::command(std::int64_t now_us, const std::string& to, const std::string& verb,
                       const bus::Rig& rig, const std::string& a, const std::string& b) {
  for (const std::string process : commanded_processes) {
    if (to != "*" && to != process) continue;
    for (const bus::PairConfig& pair : rig.pairs) {
      if (!a.empty() && (pair.a != a || pair.b != b)) continue;
      Wish& wish = of(process, bus::problem_channel(pair.a, pair.b).substr(bus::problem_prefix.size()));
      if (verb == "reset") wish.reset_us = now_us;
      if (verb == "pause" && wish.paused_us < 0) wish.paused_us = now_us;
      if (verb == "resume") wish.paused_us = wish.paused_seq = -1;
    }
  }
}

}  // namespace egocal::simulation
