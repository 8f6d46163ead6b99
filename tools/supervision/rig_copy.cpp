// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/rig_copy.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "egocal/error.hpp"

namespace egocal::tools {

RigCopy::RigCopy(const std::string& file) {
  const std::string text = bus::rig_text(file);
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
