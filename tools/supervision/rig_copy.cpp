// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/rig_copy.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

/// At most one byte more than a rig can have, which parse_rig() then refuses.
std::string text_of_rig(const std::string& file) {
  constexpr std::size_t enough = (std::size_t{1} << 20) + 1;  // [bytes]
  std::error_code none;  // what cannot be looked at cannot be opened either
  if (std::filesystem::is_directory(file, none))
    throw error_at(file, 0, "", "is a folder, expected a rig file");
  std::ifstream in(file, std::ios::binary);
  std::string text(enough, '\0');
  if (in.is_open()) in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad())
    throw error_at(file, 0, "", std::string("cannot be read as a rig file: ") + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace

RigCopy::RigCopy(const std::string& file) {
  const std::string text = text_of_rig(file);
  rig_ = bus::parse_rig(text, file);
  fd_ = memfd_create("rig", 0);  // programs that are executed inherit it
  std::size_t done = 0;
  while (fd_ >= 0 && done < text.size()) {
    const ssize_t n = write(fd_, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  if (fd_ >= 0 && done == text.size()) return;
  const int reason = errno;
  if (fd_ >= 0) close(fd_);
  throw error_at(file, 0, "", std::string("cannot be kept in memory: ") + std::strerror(reason));
}

RigCopy::~RigCopy() {
  close(fd_);
}

std::string RigCopy::name_for_programs() const {
  return "/proc/self/fd/" + std::to_string(fd_);
}

}  // namespace egocal::tools
