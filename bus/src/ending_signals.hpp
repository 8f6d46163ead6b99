// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>

namespace egocal::bus {

/// SIGINT and SIGTERM as a file descriptor. While it exists both are blocked, also in threads that start
/// later.
class EndingSignals {
 public:
  /// wanted: otherwise nothing is blocked and fd() is -1. Throws Error where the kernel gives no descriptor.
  explicit EndingSignals(bool wanted);
  ~EndingSignals();
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  int fd() const { return fd_; }
  /// The number of one signal that has come; 0: none.
  int read_one() const;

 private:
  sigset_t before_{};
  int fd_ = -1;
};

}  // namespace egocal::bus
