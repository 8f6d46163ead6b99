// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "egocal/error.hpp"

namespace egocal::services {

namespace {

/// A disk that is full or read-only still has the lock file of an earlier process.
int open_lock(const std::string& file) {
  int fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
  const int reason = errno;
  if (fd < 0) fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) throw error_at(file, 0, "", std::string("cannot be written: ") + std::strerror(reason));
  struct stat status {};
  if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode)) return fd;
  close(fd);
  throw error_at(file, 0, "", "is there and is not a file");
}

int locked(const std::string& file) {
  const int fd = open_lock(file + ".lock");
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  const int reason = errno;
  close(fd);
  if (reason == EWOULDBLOCK)
    throw error_at(file, 0, "", "is the state of another process that is running; each needs its own");
  throw error_at(file, 0, "",
                 std::string("cannot be locked: ") + std::strerror(reason) +
                     "; expected a file system with locks, such as a local disk");
}

}  // namespace

StateLock::StateLock(const std::string& file) : file_(file), fd_(locked(file)) {}

StateLock::~StateLock() {
  close(fd_);
}

void StateLock::confirm() {
  struct stat ours {
  }, there{};
  const std::string name = file_ + ".lock";
  if (fstat(fd_, &ours) == 0 && stat(name.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
      ours.st_dev == there.st_dev)
    return;
  const int fd = locked(file_);
  close(fd_);
  fd_ = fd;
}

}  // namespace egocal::services
