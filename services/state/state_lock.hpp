// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::services {

/// FILE.lock, locked by one process until it ends. The file remains, empty: if it were removed while another
/// process waits for it, two processes could hold the lock.
class StateLock {
 public:
  /// Throws Error where another process holds it, or where the file system cannot lock.
  explicit StateLock(const std::string& file);
  ~StateLock();
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

  /// Throws Error if the lock file was removed meanwhile and another process holds a new one.
  void confirm();

 private:
  std::string file_;  ///< the state
  int fd_ = -1;
};

}  // namespace egocal::services
