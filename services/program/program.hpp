// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/rig.hpp"

namespace egocal::services {

/// An option with a value. The initial value of the variable is the default.
struct TextOption {
  std::string name;  ///< "--method"
  std::string help;
  std::string* value;
  std::vector<std::string> choices;  ///< empty: any text
};

struct FlagOption {
  std::string name;
  std::string help;
  bool* value;
};

struct ProgramDescription {
  std::string name;  ///< also the default of --name
  bus::Role role = bus::Role::monitor;
  std::string version;
  std::string help;
  std::vector<TextOption> options;
  std::vector<FlagOption> flags;
};

/// What the command line says about the bus.
struct BusOptions {
  std::string rig_file, url;  ///< url: empty: the rig's
  std::string name;           ///< of the process
  bool needs_rig = true;      ///< false: an empty rig where no file is named
};

/// Connects and calls work with everything wired. A network that is away, and one that is back, are reported
/// on standard error, one line each. Exit codes: 0, 1 failure (one line on standard error), 2 wrong usage.
int run_on_bus(const ProgramDescription& description, const BusOptions& options,
               const std::function<void(bus::Loop&, bus::Heartbeat&, const bus::Rig&)>& work);

/// The main() of a process that needs a rig and LCM: reads --rig, --lcm-url, --name and the program's own
/// options, connects, calls start with everything wired and runs the loop until SIGINT or SIGTERM. start
/// returns what must exist meanwhile. Exit codes: 0 ended by a signal, 1 failure (one line on standard
/// error), 2 wrong usage.
int run_program(
    int argc, char** argv, const ProgramDescription& description,
    const std::function<std::shared_ptr<void>(bus::Loop&, bus::Heartbeat&, const bus::Rig&)>& start);

}  // namespace egocal::services
