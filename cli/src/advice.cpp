// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "advice.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "values.hpp"

namespace egocal::cli {

namespace {

/// Distance of two words: insertions, deletions, replacements and swaps of neighbours that turn one into the
/// other (Damerau-Levenshtein).
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::array<std::vector<std::size_t>, 3> rows;  // the one before the last, the last one, this one
  rows.fill(std::vector<std::size_t>(to.size() + 1));
  for (std::size_t j = 0; j <= to.size(); ++j) rows[2][j] = j;
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    auto& [before, last, row] = rows;
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t exchanged = last[j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      row[j] = std::min({exchanged, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return rows[2].back();
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_positional()) names.push_back("--" + option->get_single_name());
  return names;
}

/// "egocal solve --topic x" was given: the command at which parsing ended.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

/// "egocal log export".
std::string path_of(const CLI::App& app) {
  std::string path = app.get_name();
  for (const CLI::App* parent = app.get_parent(); parent; parent = parent->get_parent())
    path = parent->get_name() + " " + path;
  return path;
}

/// "ONE verb OTHER", as CLI11 words it, in its two names.
std::optional<std::pair<std::string, std::string>> around(const std::string& verb, const std::string& text) {
  const std::size_t at = text.find(verb);
  if (at == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + verb.size()));
}

/// What CLI11 did not know what to do with.
std::string in_words_unexpected(const CLI::App& command, std::string word) {
  const std::string see = "; see " + path_of(command) + " --help";
  word = word.substr(0, word.find('='));
  if (word.rfind('-', 0) != 0) return "'" + word + "' is one argument too many" + see;
  if (word == "--topic" || word == "--topics")
    return word + " is no option; a topic is written behind its file: recording.bag:/odom";
  const std::string meant = closest(word, option_names(command));
  return word + " is no option of " + path_of(command) +
         (meant.empty() ? see : "; did you mean " + meant + "?");
}

}  // namespace

std::string closest(const std::string& word, const std::vector<std::string>& names) {
  const auto bare = [](const std::string& name) { return name.substr(name.rfind("--", 0) == 0 ? 2 : 0); };
  const std::string meant = bare(word);
  // a third of the letters may be wrong; words of two letters are near every other word
  std::size_t best_distance = std::max<std::size_t>(meant.size() > 2 ? 1 : 0, meant.size() / 3) + 1;
  std::string best;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(meant, bare(name));
    if (distance >= best_distance) continue;
    best = name;
    best_distance = distance;
  }
  return best;
}

std::string wrong_command(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* at = &program;
  for (const std::string& word : arguments) {
    const std::vector<std::string> names = subcommand_names(*at);
    if (names.empty()) return "";
    if (word.rfind("--", 0) == 0) {
      const std::vector<std::string> options = option_names(*at);
      if (std::find(options.begin(), options.end(), word) == options.end())
        return in_words_unexpected(*at, word);
    }
    if (word.rfind('-', 0) == 0) continue;
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      const std::string meant = closest(word, names);
      return "'" + word + "' is no command of " + path_of(*at) +
             (meant.empty() ? "; expected " + alternatives(names) : "; did you mean " + meant + "?");
    }
    at = at->get_subcommand(word);
  }
  return "";
}

std::string in_words(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& command = innermost(program);
  const std::string see = "; see " + path_of(command) + " --help";
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
    if (const std::vector<std::string> words = program.remaining(true); !words.empty())
      return in_words_unexpected(command, words.front());
  const std::vector<std::string> commands = subcommand_names(command);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !commands.empty())
    return (command.get_parent() ? path_of(command) + ": " : "") +
           "expected a command: " + alternatives(commands) + see;
  const std::string text = error.what();
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    if (const auto names = around(" requires ", text))
      return names->first + ": goes with " + names->second + ", which is not given" + see;
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    if (const auto names = around(" excludes ", text))
      return names->first + ", " + names->second + ": exclude each other: give one of them" + see;
  const std::string name = text.substr(0, text.find(':'));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return name +
           (text.find("eceived") == std::string::npos ? ": expected a value" : ": is given more than once") +
           see;
  constexpr std::string_view conversion = "Could not convert: ";  // NAME = VALUE
  if (text.rfind(conversion, 0) == 0) {
    const std::size_t equals = std::min(text.find(" = "), text.size());
    return text.substr(conversion.size(), equals - conversion.size()) + ": cannot be understood: '" +
           text.substr(std::min(equals + 3, text.size())) + "'" + see;
  }
  return text + see;
}

}  // namespace egocal::cli
