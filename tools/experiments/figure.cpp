// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/figure.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"

extern char** environ;

namespace egocal::tools {

namespace {

/// False where gnuplot is missing or fails: a plot is a convenience, the CSV is the result.
bool draw(const std::string& script) {
  std::string program = "gnuplot", argument = script;
  std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;  // its remarks are for people who draw by hand
  if (posix_spawn_file_actions_init(&actions) != 0) return false;
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

FigureFiles figure_files(const std::string& directory, const std::string& name) {
  const std::string stem = (std::filesystem::path(directory) / name).string();
  return {stem + ".csv", stem + ".gnuplot", stem + ".png"};
}

FigureFiles write_figure(const FigureFiles& files, const std::string& csv, const std::string& script) {
  const std::filesystem::path folder = std::filesystem::path(files.csv).parent_path();
  std::error_code failure;
  if (!folder.empty()) std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string() + ": " + failure.message());
  write_whole_file(files.csv, csv);
  write_whole_file(files.script, script);
  FigureFiles written = files;
  if (!draw(files.script)) written.png.clear();
  return written;
}

}  // namespace egocal::tools
