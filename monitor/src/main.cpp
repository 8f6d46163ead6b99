// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "egocal/cli/cli.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  egocal::monitor::ProgramOptions options;
  namespace cli = egocal::cli;
  cli::Program app("egocal-monitor",
                   "egocal-monitor: shows what the calibration knows while you drive.\n"
                   "Without a terminal, or with --follow, it prints lines.",
                   EGOCAL_VERSION);
  app.add_option("--rig", options.rig, "rig file: which pairs to expect, time limits, LCM URL");
  app.add_option("--lcm-url", options.lcm_url, "LCM URL instead of the rig's");
  cli::Option log = app.add_option("--log", options.log, "show a recorded session instead of a live one");
  app.add_option("--speed", options.speed, "of the log, in times of real time; 0: at once")
      .check(egocal::cli::Check::range(0.0, 1e6))
      .needs(log);
  cli::Option once = app.add_flag("--once", options.once, "print what is known and end");
  app.add_flag("--follow", options.follow, "print lines, once a second, and events as they come")
      .excludes(once);
  cli::Option json =
      app.add_flag("--json", options.json, "print one JSON object a line (with --once or --follow)");
  app.add_option("--timeout", options.timeout_s,
                 "--once: wait at most this long for an answer of every pair [s]")
      .check(egocal::cli::Check::range(0.0, 1e6))
      .show_default();
  app.add_option("--duration", options.duration_s, "end after this time [s]; 0: never")
      .check(egocal::cli::Check::range(0.0, 1e9));
  app.add_option("--screen", options.screen, "screen to begin with: overview, detail, events or streams")
      .check(egocal::cli::Check::one_of({"overview", "detail", "events", "streams"}));
  app.add_option("--size", options.size, "with --once: print the screen as text, e.g. 100x30")
      .needs(once)
      .excludes(json);
  app.add_flag("--ascii", options.ascii, "ASCII only, also where the terminal could do more");
  app.add_flag("--mono", options.monochrome, "no colours");
  if (const auto code = app.parse(argc, argv)) return *code;
  if (options.json && !options.once) options.follow = true;
  options.version = EGOCAL_VERSION;
  try {
    return egocal::monitor::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal-monitor: %s\n", egocal::cli::text_of(error).c_str());
    return 1;
  }
}
