// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/passing_state.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal::tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* prefix = "pairing-";
constexpr const char* suffix = ".state";
constexpr const char* owner_suffix = ".owner";

/// Takes the lock by which a process owns a state file, and returns its descriptor; -1: a process owns the
/// file, or the lock cannot be opened.
int owned(const std::string& file) {
  const int fd = open((file + owner_suffix).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  const int reason = errno;
  if (fd >= 0) close(fd);
  errno = reason;
  return -1;
}

/// Whether something is there that no process can use as its state or its lock.
bool is_in_the_way(const std::string& file) {
  std::error_code none;
  const fs::file_type type = fs::status(file, none).type();
  return type != fs::file_type::not_found && type != fs::file_type::regular;
}

void remove_all_of(const std::string& file) {
  std::error_code none;
  for (const char* more : {"", ".lock", owner_suffix}) fs::remove(file + more, none);
  remove_temporaries(file);
}

}  // namespace

PassingState::PassingState(const std::string& folder) {
  for (int n = 1; owner_ < 0; ++n) {
    file_ = fmt::format("{}/{}{}{}", folder, prefix, n, suffix);
    std::error_code none;
    if (fs::exists(file_, none)) continue;  // of another command, running or not
    const std::string diagnosis = of_diagnosis(file_);
    if (is_in_the_way(file_ + ".lock") || is_in_the_way(diagnosis) || is_in_the_way(diagnosis + ".lock"))
      continue;
    owner_ = owned(file_);
    if (owner_ < 0 && errno != EWOULDBLOCK)
      throw error_at(file_ + owner_suffix, 0, "", std::string("cannot be written: ") + std::strerror(errno));
  }
}

PassingState::~PassingState() {
  close(owner_);
}

void PassingState::discard() {
  remove_all_of(of_diagnosis(file_));
  remove_all_of(file_);
}

std::vector<std::string> PassingState::left_behind(const std::string& folder) {
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    if (!entry.is_regular_file(error)) continue;
    const int fd = owned(entry.path());
    if (fd < 0) continue;
    close(fd);
    found.emplace_back(entry.last_write_time(error), entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> files;
  files.reserve(found.size());
  for (auto& [time, file] : found) files.push_back(std::move(file));
  return files;
}

}  // namespace egocal::tools
