// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <string>

namespace egocal::test {

/// A file that is never on a disk, with a name that anybody in this process can open.
class InMemoryFile {
 public:
  InMemoryFile() : fd_(memfd_create("input", MFD_CLOEXEC)) {
    if (fd_ < 0) std::abort();
  }
  ~InMemoryFile() { close(fd_); }
  InMemoryFile(const InMemoryFile&) = delete;
  InMemoryFile& operator=(const InMemoryFile&) = delete;

  void set(const void* content, std::size_t size) const {
    if (ftruncate(fd_, 0) != 0 || pwrite(fd_, content, size, 0) != static_cast<ssize_t>(size)) std::abort();
  }
  std::string name() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

}  // namespace egocal::test
