// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/program_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "egocal/error.hpp"
#include "supervision/output_file.hpp"

namespace egocal::tools {

int ProgramFiles::open_output_of(const Program& program, bool has_started) {
  if (!kept(program)) return -1;
  try {
    if (has_started) {
      std::error_code none;
      std::filesystem::create_directories(folder_, none);
    }
    return open_output(output_file(program));
  } catch (const Error& error) {
    if (!has_started) throw;
    reports_.report(std::string(error.what()) + "; its output is not kept");
    return open("/dev/null", O_WRONLY | O_CLOEXEC);
  }
}

std::vector<std::string> ProgramFiles::command_of(const Program& program, bool has_started) {
  std::vector<std::string> command = program.command;
  const auto option = std::find(command.begin(), command.end(), "--state");
  if (!has_started || option == command.end() || option + 1 == command.end()) return command;
  const std::filesystem::path folder = std::filesystem::absolute(*(option + 1)).parent_path();
  std::error_code none;
  std::filesystem::create_directories(folder, none);
  if (std::filesystem::is_directory(folder, none)) return command;
  reports_.report(
      fmt::format("{}: is gone and cannot be made again; {} starts without the state file there, and saves "
                  "nothing",
                  folder.string(), program.name));
  command.erase(option, option + 2);
  return command;
}

std::string ProgramFiles::last_line_of(const Program& program) const {
  return kept(program) ? last_line(output_file(program)) : "";
}

}  // namespace egocal::tools
