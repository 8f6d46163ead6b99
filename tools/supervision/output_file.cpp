// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/output_file.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "egocal/bus/convert.hpp"
#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

constexpr std::uintmax_t largest = 10'000'000;  // a limit [bytes]: a larger file is renamed
constexpr const char* header = "-- started ";

}  // namespace

std::string default_output_directory() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state) return std::string(state) + "/egocal";
  const char* home = std::getenv("HOME");
  std::error_code none;
  // users of services have a home that is not there
  if (home && *home && std::filesystem::is_directory(home, none))
    return std::string(home) + "/.local/state/egocal";
  const std::string folder = fmt::format("/tmp/egocal-{}", geteuid());
  require_private_folder(folder);
  return folder;
}

void require_private_folder(const std::string& folder) {
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    throw error_at(folder, 0, "", std::string("cannot be made: ") + std::strerror(errno));
  struct stat status {};
  const bool known = lstat(folder.c_str(), &status) == 0;
  if (known && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
      (status.st_mode & (S_IWGRP | S_IWOTH)) == 0)
    return;
  throw error_at(folder, 0, "",
                 "is not a folder that this user alone can write to: remove it, or name another one by "
                 "--output-dir");
}

int open_output(const std::string& file) {
  std::error_code none;
  if (std::filesystem::file_size(file, none) > largest && !none)
    std::filesystem::rename(file, file + ".old", none);
  const int fd =
      open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
  if (fd < 0) throw error_at(file, 0, "", std::string("cannot be written: ") + std::strerror(errno));
  const std::string line =
      fmt::format("{}{:%Y-%m-%d %H:%M:%S}\n", header, fmt::localtime(std::time(nullptr)));
  // a disk that is full takes no output, and that is no reason not to start
  if (write(fd, line.data(), line.size()) < 0) return fd;
  return fd;
}

std::string last_line(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  constexpr std::streamoff tail = 1000;  // bytes that hold the last line
  const std::streamoff size = stream.tellg();
  stream.seekg(std::max<std::streamoff>(0, size - tail));
  std::string line, last;
  while (std::getline(stream, line)) {
    if (line.rfind(header, 0) == 0)
      last.clear();  // nothing was written since
    else if (!line.empty())
      last = line;
  }
  return bus::printable(last);
}

}  // namespace egocal::tools
