// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cstdio>

#include "program.hpp"

int main(int argc, char** argv) {
  egocal::monitor::ProgramOptions options;
  CLI::App app{
      "egocal-monitor: shows what the calibration knows while you drive.\n"
      "Without a terminal, or with --follow, it prints lines."};
  app.set_version_flag("--version", "egocal-monitor " EGOCAL_VERSION);
  app.add_option("--rig", options.rig, "rig file: which pairs to expect, time limits, LCM URL")
      ->check(CLI::ExistingFile);
  app.add_option("--lcm-url", options.lcm_url, "LCM URL instead of the rig's");
  auto* log = app.add_option("--log", options.log, "show a recorded session instead of a live one")
                  ->check(CLI::ExistingFile);
  app.add_option("--speed", options.speed, "of the log, in times of real time; 0: at once")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(log);
  auto* once = app.add_flag("--once", options.once, "print what is known and end");
  app.add_flag("--follow", options.follow, "print lines, once a second, and events as they come")
      ->excludes(once);
  app.add_flag("--json", options.json, "print one JSON object a line (with --once or --follow)");
  app.add_option("--timeout", options.timeout_s,
                 "--once: wait at most this long for an answer of every pair [s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--duration", options.duration_s, "end by itself after this long [s]; 0: never")
      ->check(CLI::Range(0.0, 1e9));
  app.add_option("--screen", options.screen, "screen to begin with: overview, detail or events")
      ->check(CLI::IsMember({"overview", "detail", "events"}));
  app.add_option("--size", options.size, "with --once: print the screen as text, e.g. 100x30");
  app.add_flag("--ascii", options.ascii, "ASCII only, also where the terminal could do more");
  app.add_flag("--mono", options.monochrome, "no colours");
  try {
    app.parse(argc, argv);
    if (options.json && !options.once) options.follow = true;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.version = EGOCAL_VERSION;
  try {
    return egocal::monitor::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal-monitor: %s\n", error.what());
    return 1;
  }
}
