// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// A command line as data, from which manual pages and shell completion are generated.
namespace egocal::cli {

struct OptionDescription {
  std::string name;   ///< "--method", or "FILE" of a positional
  std::string value;  ///< what it takes: "TEXT", "FLOAT=0.5"; empty for a flag
  std::string help;
  std::vector<std::string> choices;  ///< the only values that are understood; empty: any
  bool positional = false, required = false;
};

struct CommandDescription {
  std::string path;  ///< "egocal log create"
  std::string help;
  std::string footer;  ///< of the whole program
  std::vector<OptionDescription> options;
  std::vector<CommandDescription> commands;
};

CommandDescription describe(const CLI::App& app);

/// The command and all below it, parents first.
std::vector<const CommandDescription*> all_commands(const CommandDescription& program);

/// "log create" of "egocal log create".
std::string last_word(const std::string& path);

}  // namespace egocal::cli
