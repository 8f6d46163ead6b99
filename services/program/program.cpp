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

int run_program(
    int argc, char** argv, const ProgramDescription& description,
    const std::function<std::shared_ptr<void>(bus::Loop&, bus::Heartbeat&, const bus::Rig&)>& start) {
  cli::Program app(description.name, description.help, description.version);
  app.footer("Exit codes: 0 ended by SIGINT or SIGTERM, 1 failure, 2 wrong usage.");
  std::string rig_file, url, name = description.name;
  app.add_option("--rig", rig_file, "the rig file (docs/rig.md)").required();
  app.add_option("--lcm-url", url, "LCM URL instead of the rig's");
  app.add_option("--name", name, "name of this process on the bus").show_default();
  for (const TextOption& option : description.options) {
    cli::Option added = app.add_option(option.name, *option.value, option.help).show_default();
    if (!option.choices.empty()) added.check(cli::Check::one_of(option.choices));
  }
  for (const FlagOption& flag : description.flags) app.add_flag(flag.name, *flag.value, flag.help);
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!bus::plausible_name(name)) {
    std::cerr << description.name << ": --name: expected 1 to 40 letters, digits, _ or -\n";
    return 2;
  }
  try {
    const bus::Rig rig = bus::read_rig(rig_file);
    bus::Loop loop(url.empty() ? rig.lcm_url : url, {.require_network = false});
    report_network(loop, name);
    const std::chrono::duration<double> timeout(rig.heartbeat_timeout);
    bus::Heartbeat heartbeat(loop, {name, description.role, description.version},
                             std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
    const std::shared_ptr<void> service = start(loop, heartbeat, rig);
    loop.run();
    heartbeat.end();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << description.name << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace egocal::services
