// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program/program.hpp"

#include <chrono>
#include <iostream>
#include <memory>

#include "egocal/bus/plausible.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/error.hpp"

namespace egocal::services {

namespace {

void report_network(bus::Loop& loop, const std::string& name) {
  const auto away = [name](const std::string& error) {
    std::cerr << name << ": " << error << "; waiting for the network\n";
  };
  if (!loop.network_error().empty()) away(loop.network_error());
  loop.on_network([&loop, name, away](const std::string& error) {
    if (!error.empty())
      away(error);
    else
      std::cerr << name << ": the network is back; " << loop.counts().not_sent
                << " messages could not be sent so far\n";
  });
}

}  // namespace

int run_on_bus(const ProgramDescription& description, const BusOptions& options,
               const std::function<void(bus::Loop&, bus::Heartbeat&, const bus::Rig&)>& work) {
  if (!bus::plausible_name(options.name)) {
    std::cerr << description.name << ": --name: expected 1 to 40 letters, digits, _ or -\n";
    return 2;
  }
  try {
    const bool has_rig = options.needs_rig || !options.rig_file.empty();
    const bus::Rig rig = has_rig ? bus::read_rig(options.rig_file) : bus::Rig{};
    bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url, {.require_network = false});
    report_network(loop, options.name);
    const std::chrono::duration<double> timeout(rig.heartbeat_timeout);
    bus::Heartbeat heartbeat(loop, {options.name, description.role, description.version},
                             std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
    work(loop, heartbeat, rig);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << description.name << ": " << cli::text_of(error) << '\n';
    return 1;
  }
}

int run_program(
    int argc, char** argv, const ProgramDescription& description,
    const std::function<std::shared_ptr<void>(bus::Loop&, bus::Heartbeat&, const bus::Rig&)>& start) {
  cli::Program app(description.name, description.help, description.version);
  app.footer("Exit codes: 0 ended by SIGINT or SIGTERM, 1 failure, 2 wrong usage.");
  BusOptions options{{}, {}, description.name};
  app.add_option("--rig", options.rig_file, "the rig file (docs/rig.md)").required();
  app.add_option("--lcm-url", options.url, "LCM URL instead of the rig's");
  app.add_option("--name", options.name, "name of this process on the bus").show_default();
  for (const TextOption& option : description.options) {
    cli::Option added = app.add_option(option.name, *option.value, option.help).show_default();
    if (!option.choices.empty()) added.check(cli::Check::one_of(option.choices));
  }
  for (const FlagOption& flag : description.flags) app.add_flag(flag.name, *flag.value, flag.help);
  if (const auto code = app.parse(argc, argv)) return *code;
  return run_on_bus(description, options,
                    [&start](bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig) {
                      const std::shared_ptr<void> service = start(loop, heartbeat, rig);
                      loop.run();
                      heartbeat.end();
                    });
}

}  // namespace egocal::services
