// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/figure.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"

extern char** environ;

namespace egocal::tools {

namespace {

/// False where rsvg-convert is missing or fails: the SVG is the result, the PDF a convenience.
bool convert_to_pdf(const std::string& svg_file, const std::string& pdf_file) {
  std::string program = "rsvg-convert", format = "--format=pdf", output = "--output=" + pdf_file,
              input = svg_file;
  std::array<char*, 5> arguments{program.data(), format.data(), output.data(), input.data(), nullptr};
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return false;
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::vector<std::string> write_figure(const std::string& directory, const std::string& name,
                                      const std::string& csv, const std::vector<Panel>& panels) {
  std::error_code failure;
  if (!directory.empty()) std::filesystem::create_directories(directory, failure);
  if (failure) throw Error(directory + ": " + failure.message());
  const std::string stem = (std::filesystem::path(directory) / name).string();
  std::vector<std::string> written{stem + ".csv"};
  write_whole_file(written.back(), csv);
  for (const Panel& panel : panels) {
    const std::string file = stem + "-" + panel.name;
    written.push_back(file + ".svg");
    write_whole_file(written.back(), svg(panel.plot));
    if (convert_to_pdf(file + ".svg", file + ".pdf")) written.push_back(file + ".pdf");
  }
  return written;
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = part * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace egocal::tools
