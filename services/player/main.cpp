// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>

#include "egocal/cli/cli.hpp"
#include "egocal/microseconds.hpp"
#include "player/player.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  const services::ProgramDescription description{"egocal-player",
                                                 bus::Role::player,
                                                 EGOCAL_VERSION,
                                                 "Plays an LCM log on the bus, in step with egocal-pairing.",
                                                 {},
                                                 {}};
  cli::Program app(description.name, description.help, description.version);
  app.footer(std::string("Keys on a terminal: ") + services::keys_help +
             ".\nVerbs on EGOCAL_COMMAND: pause, resume, step, \"seek S\", \"speed S\" (docs/processes.md).\n"
             "Exit codes: 0 played or ended by a signal, 1 failure, 2 wrong usage.");
  services::PlayerOptions options;
  services::BusOptions on_bus{{}, {}, description.name, false};
  double end = -1, wait_for_pairing = to_seconds(options.pace.wait_for_pairing_us);
  app.add_option("LOG", options.log, "the log, as lcm-logger or egocal wrote it").required();
  app.add_option("--rig", on_bus.rig_file, "rig file, for its LCM URL");
  app.add_option("--lcm-url", on_bus.url, "LCM URL instead of the rig's");
  app.add_option("--name", on_bus.name, "name of this process on the bus").show_default();
  app.add_option("--speed", options.speed, "times real time; 0: as fast as pairing takes it in")
      .check(egocal::cli::Check::range(0.0, 1e6))
      .show_default();
  app.add_flag("--loop", options.loop, "from the beginning again at the end, as another session");
  app.add_flag("--paused", options.paused, "wait for resume");
  app.add_option("--start", options.range.start, "begin so far into the log [s]")
      .check(egocal::cli::Check::not_negative());
  app.add_option("--end", end, "end so far into the log [s]").check(egocal::cli::Check::not_negative());
  app.add_option("--wait-for-pairing", wait_for_pairing,
                 "then the log is played to any listener [s]; what pairing is not there for cannot be sent "
                 "to it again")
      .check(egocal::cli::Check::range(0.0, 1e9))
      .show_default();
  app.add_option("--channel", options.range.channel,
                 "regular expression: only these channels; default: all but EGOCAL_*");
  if (const auto code = app.parse(argc, argv)) return *code;
  if (end >= 0) options.range.end = end;
  options.pace.wait_for_pairing_us = to_microseconds(wait_for_pairing);
  return services::run_on_bus(description, on_bus, [&](auto& loop, auto& heartbeat, const auto&) {
    services::Player player(loop, heartbeat, options);
    loop.run();
    player.report();
    heartbeat.end();
  });
}
