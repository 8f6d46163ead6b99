// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/cli/cli.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "completion.hpp"
#include "manual.hpp"

namespace egocal::cli {

namespace {

/// Insertions, deletions and exchanges that make one word of the other (Levenshtein).
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> row(to.size() + 1);
  for (std::size_t j = 0; j <= to.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t exchanged = diagonal + (from[i - 1] == to[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({exchanged, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

/// The name of the given ones that a mistyped word most likely meant; empty where none is close.
std::string closest(const std::string& word, const std::vector<std::string>& names) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(word, name);
    if (distance >= best_distance) continue;
    best = name;
    best_distance = distance;
  }
  return best;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_single_name();
    if (!option->get_positional()) names.push_back("--" + name);
  }
  return names;
}

/// "egocal solve --topic x" was given: the command at which parsing ended.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

/// What the user may have meant, as the end of an error's line.
std::string advice(const CLI::App& program, int argc, char** argv) {
  const CLI::App& command = innermost(program);
  const std::vector<std::string> options = option_names(command), commands = subcommand_names(command);
  for (int i = 1; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (word == "--topic" || word == "--topics")
      return "; a topic is written behind its file: recording.bag:/odom";
    const bool is_option = word.rfind("--", 0) == 0;
    const auto& names = is_option ? options : commands;
    if (names.empty() || std::find(names.begin(), names.end(), word) != names.end()) continue;
    if (!is_option && word == command.get_name()) continue;
    const std::string meant = closest(word, names);
    if (!meant.empty()) return "; did you mean " + meant + "?";
    if (!is_option) break;
  }
  const std::string name = &command == &program ? "" : program.get_name() + " ";
  return "; see " + name + command.get_name() + " --help";
}

bool same_file(const std::string& one, const std::string& other) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::path(one).lexically_normal() == fs::path(other).lexically_normal() ||
         fs::equivalent(one, other, ignored);
}

/// value: FILE, FILE:TOPIC, NAME=FILE or NAME=FILE:TOPIC.
bool names_file(const std::string& value, const std::string& file) {
  const std::size_t equals = value.find('=');
  for (const std::string& text : {value, equals == std::string::npos ? "" : value.substr(equals + 1)}) {
    if (text.empty()) continue;
    if (same_file(text, file)) return true;
    for (std::size_t colon = text.find(':'); colon != std::string::npos; colon = text.find(':', colon + 1))
      if (colon > 0 && same_file(text.substr(0, colon), file)) return true;
  }
  return false;
}

/// A value of the command, other than that of `output`, that names the same file; empty: none.
std::string named_again(const CLI::App& command, const CLI::Option& output, const std::string& file) {
  if (file.empty()) return "";
  for (const CLI::Option* option : command.get_options()) {
    const bool one_of_some_words = option->get_type_name().find('{') != std::string::npos;
    if (option == &output || one_of_some_words) continue;
    for (const std::string& value : option->results())
      if (names_file(value, file)) return value;
  }
  return "";
}

void write_file(const std::string& name, const std::string& text) {
  std::ofstream file(name, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(name + ": cannot be written");
}

/// `--completion SHELL` prints a script; `--manual FOLDER VERSION` writes the manual pages and the scripts
/// into a folder, for packages. Not listed in the help. Empty: neither was given.
std::optional<int> write_description(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.size() == 2 && arguments[0] == "--completion") {
    const CommandDescription program = describe(app);
    if (arguments[1] != "bash" && arguments[1] != "zsh" && arguments[1] != "fish")
      throw UsageError("--completion: expected bash, zsh or fish, got '" + arguments[1] + "'");
    const std::string script = arguments[1] == "bash"  ? bash_completion(program)
                               : arguments[1] == "zsh" ? zsh_completion(program)
                                                       : fish_completion(program);
    std::fputs(script.c_str(), stdout);
    return 0;
  }
  if (arguments.size() != 3 || arguments[0] != "--manual") return std::nullopt;
  const CommandDescription program = describe(app);
  const std::string folder = arguments[1] + "/";
  for (const CommandDescription* command : all_commands(program))
    write_file(folder + manual_file(*command), manual_page(*command, arguments[2]));
  write_file(folder + program.path + ".bash", bash_completion(program));
  write_file(folder + "_" + program.path, zsh_completion(program));
  write_file(folder + program.path + ".fish", fish_completion(program));
  return 0;
}

/// What was printed has arrived. Throws std::runtime_error otherwise: a full disk, a closed output.
void finish_output() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const int reason = errno;
  std::clearerr(stdout);
  throw std::runtime_error("standard output: cannot be written" +
                           (reason == 0 ? "" : ": " + std::generic_category().message(reason)));
}

void print_error(const std::string& name, const std::string& message) {
  std::string line = message;
  // what was typed may hold control characters
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\n' ? ' ' : '?';
  std::fprintf(stderr, "%s: %s\n", name.c_str(), line.c_str());
}

}  // namespace

Check Check::one_of(std::vector<std::string> values) {
  Check check;
  check.kind_ = Kind::one_of;
  check.values_ = std::move(values);
  return check;
}

Check Check::range(double least, double most) {
  Check check;
  check.least_ = least;
  check.most_ = most;
  return check;
}

Check Check::not_negative() {
  Check check;
  check.kind_ = Kind::not_negative;
  return check;
}

Check Check::above_zero(double most) {
  Check check;
  check.kind_ = Kind::above_zero;
  check.most_ = most;
  return check;
}

Check Check::existing_file() {
  Check check;
  check.kind_ = Kind::existing_file;
  return check;
}

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::check(const Check& check) {
  // NaN is in no range, and infinity is no amount
  const auto number = [](const std::string& text) {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return good ? value : std::numeric_limits<double>::quiet_NaN();
  };
  switch (check.kind_) {
    case Check::Kind::one_of:
      option_->check(CLI::IsMember(check.values_));
      break;
    case Check::Kind::range:
      option_->check(CLI::Range(check.least_, check.most_));
      option_->check(CLI::Validator(
          [number](std::string& text) {
            return std::isnan(number(text)) ? "expected a number, got '" + text + "'" : std::string();
          },
          ""));
      break;
    case Check::Kind::not_negative:
      option_->check(CLI::Validator(
          [number](std::string& text) {
            const bool good = number(text) >= 0;
            return good ? std::string() : "expected a number from 0 up, got '" + text + "'";
          },
          "NUMBER >= 0"));
      break;
    case Check::Kind::above_zero:
      option_->check(CLI::Validator(
          [number, most = check.most_](std::string& text) {
            const double value = number(text);
            if (value > 0 && value <= most) return std::string();
            char limit[32];
            std::snprintf(limit, sizeof limit, "%.0f", most);
            return std::string("expected a number above 0, at most ") + limit + ", got '" + text + "'";
          },
          "NUMBER > 0"));
      break;
    case Check::Kind::existing_file:
      option_->check(CLI::ExistingFile);
      break;
  }
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::each_a_value() {
  option_->expected(1)->take_all();
  return *this;
}

Option& Option::comma_separated() {
  option_->delimiter(',');
  return *this;
}

template <class Value>
Option App::add_option(const std::string& name, Value& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
template Option App::add_option(const std::string&, std::string&, const std::string&);
template Option App::add_option(const std::string&, bool&, const std::string&);
template Option App::add_option(const std::string&, int&, const std::string&);
template Option App::add_option(const std::string&, unsigned&, const std::string&);
template Option App::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option App::add_option(const std::string&, std::int64_t&, const std::string&);
template Option App::add_option(const std::string&, double&, const std::string&);
template Option App::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option App::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option App::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option App::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option App::add_option(const std::string&, std::optional<std::string>&, const std::string&);

Option App::add_output(const std::string& name, std::string& file, const std::string& help, bool in_place) {
  CLI::Option* option = app_->add_option(name, file, help);
  if (in_place) return Option(option);
  // options are checked when all of the command line is known
  option->check(CLI::Validator(
      [command = app_, option](std::string& value) {
        const std::string again = named_again(*command, *option, value);
        return again.empty() ? std::string()
                             : value + " is given as '" + again + "' as well: give the output another name";
      },
      ""));
  return Option(option);
}

Option App::add_option_function(const std::string& name, std::function<void(const std::string&)> take,
                                const std::string& help) {
  return Option(app_->add_option_function<std::string>(name, std::move(take), help));
}

Option App::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

App App::add_subcommand(const std::string& name, const std::string& help) {
  return App(app_->add_subcommand(name, help));
}

void App::require_subcommand() {
  app_->require_subcommand(1);
}

void App::callback(std::function<void()> work) {
  app_->callback(std::move(work));
}

std::string App::command_line() const {
  const auto quoted = [](const std::string& word) {
    constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
  };
  std::string line = app_->get_name();
  for (const CLI::App* parent = app_->get_parent(); parent; parent = parent->get_parent())
    line = parent->get_name() + " " + line;
  for (const CLI::Option* option : app_->get_options()) {
    if (option->count() == 0) continue;
    const bool flag = option->get_items_expected_max() == 0;
    if (flag) {
      line += " --" + option->get_single_name();
      continue;
    }
    for (const std::string& value : option->results())
      line += (option->get_positional() ? " " : " --" + option->get_single_name() + " ") + quoted(value);
  }
  return line;
}

bool App::given() const {
  return app_->parsed();
}

bool App::given(const std::string& option) const {
  return app_->count(option) > 0;
}

void App::footer(const std::string& text) {
  app_->footer(text);
}

Program::Program(const std::string& name, const std::string& help, const std::string& version)
    : App(nullptr), owned_(std::make_unique<CLI::App>(help, name)) {
  app_ = owned_.get();
  // a limit on the size of files is an error of the write, with its line, not a death
  std::signal(SIGXFSZ, SIG_IGN);
  if (!version.empty()) app_->set_version_flag("--version", name + " " + version);
}

Program::~Program() = default;

std::optional<int> Program::parse(int argc, char** argv) {
  const std::string name = app_->get_name();
  // `egocal help solve` is `egocal solve --help`
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments.front() == "help" && !app_->get_subcommands({}).empty()) {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  try {
    if (const std::optional<int> written = write_description(*app_, arguments)) return written;
    std::reverse(arguments.begin(), arguments.end());
    std::optional<int> code;
    try {
      app_->parse(arguments);
    } catch (const Exit& exit) {
      code = exit.code;
    } catch (const CLI::Success& success) {
      code = app_->exit(success);
    }
    finish_output();
    return code;
  } catch (const CLI::ParseError& error) {
    print_error(name, error.what() + advice(*app_, argc, argv));
    return 2;
  } catch (const UsageError& error) {
    print_error(name, error.what());
    return 2;
  } catch (const std::exception& error) {
    print_error(name, error.what());
    return 1;
  }
}

}  // namespace egocal::cli
