// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/cli/cli.hpp"
#include "player/player.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  cli::Program app("egocal-player", "Plays an LCM log on the bus, in step with egocal-pairing.",
                   EGOCAL_VERSION);
  app.footer(std::string("Keys on a terminal: ") + services::keys_help +
             ".\nVerbs on EGOCAL_COMMAND: pause, resume, step, \"seek S\", \"speed S\" (docs/processes.md).\n"
             "Exit codes: 0 played or ended by a signal, 1 failure, 2 wrong usage.");
  services::PlayerOptions options;
  std::string rig_file, url, name = "egocal-player";
  double end = -1;
  app.add_option("LOG", options.log, "the log, as lcm-logger or egocal wrote it").required();
  app.add_option("--rig", rig_file, "rig file, for its LCM URL");
  app.add_option("--lcm-url", url, "LCM URL instead of the rig's");
  app.add_option("--name", name, "name of this process on the bus").show_default();
  app.add_option("--speed", options.speed, "times real time; 0: as fast as pairing takes it in")
      .check(egocal::cli::Check::range(0.0, 1e6))
      .show_default();
  app.add_flag("--loop", options.loop, "from the beginning again at the end, as another session");
  app.add_flag("--paused", options.paused, "wait for resume");
  app.add_option("--start", options.range.start, "begin so far into the log [s]")
      .check(egocal::cli::Check::not_negative());
  app.add_option("--end", end, "end so far into the log [s]").check(egocal::cli::Check::not_negative());
  app.add_option("--channel", options.range.channel,
                 "regular expression: only these channels; default: all but EGOCAL_*");
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!bus::plausible_name(name)) {
    std::cerr << "egocal-player: --name: expected 1 to 40 letters, digits, _ or -\n";
    return 2;
  }
  try {
    if (end >= 0) options.range.end = end;
    const bus::Rig rig = rig_file.empty() ? bus::Rig{} : bus::read_rig(rig_file);
    bus::Loop loop(url.empty() ? rig.lcm_url : url, {.require_network = false});
    services::report_network(loop, name);
    const std::chrono::duration<double> timeout(rig.heartbeat_timeout);
    bus::Heartbeat heartbeat(loop, {name, bus::Role::player, EGOCAL_VERSION},
                             std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
    services::Player player(loop, heartbeat, options);
    loop.run();
    player.report();
    heartbeat.end();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "egocal-player: " << error.what() << '\n';
    return 1;
  }
}
