// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <string>

namespace egocal::test {

inline void set_content(int fd, const void* content, std::size_t size) {
  if (ftruncate(fd, 0) != 0 || pwrite(fd, content, size, 0) != static_cast<ssize_t>(size)) std::abort();
}

/// A file in memory, with a name that any code of this process can open.
class InMemoryFile {
 public:
  InMemoryFile() : fd_(memfd_create("input", MFD_CLOEXEC)) {
    if (fd_ < 0) std::abort();
  }
  ~InMemoryFile() { close(fd_); }
  InMemoryFile(const InMemoryFile&) = delete;
  InMemoryFile& operator=(const InMemoryFile&) = delete;

  void set(const void* content, std::size_t size) const { set_content(fd_, content, size); }
  std::string name() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// The same with a name of its own, for libraries that follow links (sqlite3). Removed by the destructor.
class NamedMemoryFile {
 public:
  NamedMemoryFile() : fd_(mkstemp(name_.data())) {
    if (fd_ < 0) std::abort();
  }
  ~NamedMemoryFile() {
    close(fd_);
    unlink(name_.c_str());
  }
  NamedMemoryFile(const NamedMemoryFile&) = delete;
  NamedMemoryFile& operator=(const NamedMemoryFile&) = delete;

  void set(const void* content, std::size_t size) const { set_content(fd_, content, size); }
  const std::string& name() const { return name_; }

 private:
  std::string name_ = "/dev/shm/egocal_XXXXXX";
  int fd_;
};

}  // namespace egocal::test
