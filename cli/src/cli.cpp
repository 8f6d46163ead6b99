// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/cli/cli.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>
#include <utility>

#include "advice.hpp"
#include "completion.hpp"
#include "manual.hpp"
#include "values.hpp"

namespace egocal::cli {

namespace {

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

/// Another value of the command than `output` that names the same file; empty: none.
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

/// CLI11 takes the next argument for the value of `--goal=`.
void refuse_empty_values(const std::vector<std::string>& arguments) {
  for (const std::string& word : arguments)
    if (word.rfind("--", 0) == 0 && word.size() > 3 && word.find('=') == word.size() - 1)
      throw UsageError(word.substr(0, word.size() - 1) +
                       ": expected a value behind '='; is a variable of the shell not set?");
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

/// reason: of the system; empty: it has given none.
std::string output_error(const std::string& reason) {
  return "standard output: cannot be written" + (reason.empty() ? "" : ": " + reason);
}

/// Flushes standard output. Throws std::runtime_error if it was not written: a full disk, a closed output.
void finish_output() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const int reason = errno;
  std::clearerr(stdout);
  throw std::runtime_error(output_error(reason == 0 ? "" : std::generic_category().message(reason)));
}

void print_error(const std::string& name, const std::string& message) {
  std::string line = message;
  // what was typed may hold control characters
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\n' ? ' ' : '?';
  std::fprintf(stderr, "%s: %s\n", name.c_str(), line.c_str());
}

}  // namespace

std::string text_of(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) ? "not enough memory" : error.what();
}

Option& Option::required() {
  option_->required();
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
  CLI::Option* option = app_->add_option(name, value, help);
  check_type<Value>(*option);
  return Option(option);
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
  check_type<std::string>(*option);
  option->check(CLI::Validator(
      [](std::string& value) {
        return value == "-" ? "'-' is not taken for standard output: expected the name of a file"
                            : std::string();
      },
      ""));
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
  CLI::Option* option = app_->add_option_function<std::string>(name, std::move(take), help);
  check_type<std::string>(*option);
  return Option(option);
}

Option App::add_flag(const std::string& name, bool& value, const std::string& help) {
  CLI::Option* const flag = app_->add_flag(name, value, help);
  flag->check(no_value());
  return Option(flag);
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
  // exceeding the size limit of files becomes an error of the write instead of killing the process
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
    if (const std::string wrong = wrong_command(*app_, arguments); !wrong.empty()) throw UsageError(wrong);
    refuse_empty_values(arguments);
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
    print_error(name, in_words(error, *app_));
    return 2;
  } catch (const UsageError& error) {
    print_error(name, error.what());
    return 2;
  } catch (const std::system_error& error) {
    // fmt says "cannot write to file" of it
    const bool of_output = std::ferror(stdout) != 0;
    std::clearerr(stdout);
    print_error(name, of_output ? output_error(error.code().message()) : error.what());
    return 1;
  } catch (const std::exception& error) {
    print_error(name, text_of(error));
    return 1;
  }
}

}  // namespace egocal::cli
