// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// Command lines. CLI11 does the work; this header keeps its templates, eleven seconds of compilation a file,
/// in one file. Names follow CLI11's.
namespace egocal::cli {

/// An option that cannot be understood: one line on standard error, exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a failure says to people: its own text, or "not enough memory", as that failure has none.
std::string text_of(const std::exception& error);

/// Ends the program with this exit code; the command has already said why.
struct Exit {
  int code = 0;
};

/// What a value must satisfy.
class Check {
 public:
  static Check one_of(std::vector<std::string> values);
  static Check range(double least, double most);  ///< inclusive
  static Check not_negative();
  static Check above_zero(double most, double least = 0);

 private:
  friend class Option;
  enum class Kind { one_of, range, not_negative, above_zero };
  Kind kind_ = Kind::range;
  std::vector<std::string> values_;
  double least_ = 0, most_ = 0;
};

/// An option of a command; a handle, copied freely.
class Option {
 public:
  Option& required();
  Option& check(const Check& check);
  Option& show_default();          ///< the variable's present value is shown in the help
  Option& needs(Option other);     ///< is only understood together with the other one
  Option& excludes(Option other);  ///< is not understood together with the other one
  Option& each_a_value();          ///< of a list: one value each time it is given
  Option& comma_separated();       ///< of a list: values between commas

 private:
  friend class App;
  explicit Option(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

/// A program or one of its commands; a handle, copied freely. Variables must exist until the command has run.
class App {
 public:
  /// Value: std::string, bool, int, unsigned, std::uint64_t, std::int64_t, double, a std::vector of strings
  /// or of doubles, or a std::optional of int, double or string. name: "--long" or "POSITIONAL". An empty
  /// text is no value of any of them.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& help = "");
  /// The name of a file that the command writes. Refused where another value of the command line names that
  /// file (also as FILE:TOPIC and NAME=FILE): what the command reads is never replaced. in_place: it may be,
  /// for a command that repairs a file in place and writes it whole or not at all. "-" is no file.
  Option add_output(const std::string& name, std::string& file, const std::string& help,
                    bool in_place = false);
  /// The function is called with the text of the option.
  Option add_option_function(const std::string& name, std::function<void(const std::string&)> take,
                             const std::string& help);
  Option add_flag(const std::string& name, bool& value, const std::string& help);

  App add_subcommand(const std::string& name, const std::string& help);
  void require_subcommand();
  /// Runs when the command line is complete and this command was given.
  void callback(std::function<void()> work);
  void footer(const std::string& text);
  /// The command and its options as they were given, as a shell would read them.
  std::string command_line() const;
  bool given() const;                           ///< this command is on the command line that was parsed
  bool given(const std::string& option) const;  ///< and this option of it, such as "--out"

 protected:
  explicit App(CLI::App* app) : app_(app) {}
  CLI::App* app_;
};

/// The program itself.
class Program : public App {
 public:
  /// version: what --version prints after the name; empty: there is no --version.
  Program(const std::string& name, const std::string& help, const std::string& version = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Parses the command line and runs the callbacks of the commands that were given. Errors become one line
  /// on standard error. Returns the exit code: 0 success, 1 failure, 2 wrong usage, or that of an Exit.
  int run(int argc, char** argv) { return parse(argc, argv).value_or(0); }

  /// The same for a main() that continues afterwards; an exit code where the program must end (an error, or
  /// --help was answered).
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> owned_;
};

}  // namespace egocal::cli
