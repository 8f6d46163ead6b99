// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "arguments.hpp"
#include "commands/commands.hpp"

int main(int argc, char** argv) {
  CLI::App program("egocal: where sensors sit relative to each other, from their motions alone, with proof");
  program.set_version_flag("--version", "egocal " EGOCAL_VERSION);
  program.require_subcommand(1);
  program.footer("Exit codes: 0 success, 1 failure (one line on standard error), 2 wrong usage.");
  egocal::tools::add_commands(program);
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& success) {
    return program.exit(success);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();  // the command has said why
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "egocal: %s (see egocal --help)\n", error.what());
    return 2;
  } catch (const egocal::tools::UsageError& error) {
    std::fprintf(stderr, "egocal: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal: %s\n", error.what());
    return 1;
  }
}
