// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "description.hpp"

#include <CLI/CLI.hpp>

namespace egocal::cli {

namespace {

/// CLI11 shows a set of allowed values as "TEXT:{a,b}".
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return choices;
  std::string rest = type.substr(begin + 1, end - begin - 1);
  for (std::size_t comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    choices.push_back(rest.substr(0, comma));
    rest.erase(0, comma + 1);
  }
  choices.push_back(rest);
  return choices;
}

OptionDescription describe(const CLI::Option& option) {
  OptionDescription result;
  result.positional = option.get_positional();
  result.name = (result.positional ? "" : "--") + option.get_single_name();
  result.help = option.get_description();
  result.required = option.get_required();
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() == 0) return result;
  result.choices = choices_in(type);
  result.value = type.substr(0, type.find_first_of(":{"));
  if (!option.get_default_str().empty()) result.value += "=" + option.get_default_str();
  return result;
}

CommandDescription describe(const CLI::App& app, const std::string& parent, const std::string& footer) {
  CommandDescription result;
  result.path = (parent.empty() ? "" : parent + " ") + app.get_name();
  result.help = app.get_description();
  result.footer = footer;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) result.options.push_back(describe(*option));
  for (const CLI::App* command : app.get_subcommands({}))
    result.commands.push_back(describe(*command, result.path, footer));
  return result;
}

void collect(const CommandDescription& command, std::vector<const CommandDescription*>& all) {
  all.push_back(&command);
  for (const CommandDescription& below : command.commands) collect(below, all);
}

}  // namespace

CommandDescription describe(const CLI::App& app) {
  return describe(app, "", app.get_footer());
}

std::vector<const CommandDescription*> all_commands(const CommandDescription& program) {
  std::vector<const CommandDescription*> all;
  collect(program, all);
  return all;
}

std::string last_word(const std::string& path) {
  return path.substr(path.find_last_of(' ') + 1);
}

}  // namespace egocal::cli
