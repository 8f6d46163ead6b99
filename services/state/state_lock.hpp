// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::services {

/// FILE.lock, held for one process alone until the end. It remains as an empty file: to remove it while
/// another process waits for it would let two continue.
class StateLock {
 public:
  /// Throws Error where another process holds it, or where the file system cannot lock.
  explicit StateLock(const std::string& file);
  ~StateLock();
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

  /// Throws Error where the lock file was removed meanwhile and another process has taken its place.
  void confirm();

 private:
  std::string file_;  ///< the state
  int fd_ = -1;
};

}  // namespace egocal::services
