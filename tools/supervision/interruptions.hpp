// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace egocal::tools {

/// A signal ends `egocal up` as a user means it, at any time: with what was calibrated so far, of which
/// there is nothing at first. A closed output does not end it. One at a time, on the main thread.
class Interruptions {
 public:
  /// player: a log is to be played, which is a failure where nothing is calibrated.
  explicit Interruptions(bool player);
  ~Interruptions() { release(); }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;

  /// From now on the signals wait for the supervisor.
  void hold();
  /// From now on the signals end this process, as any other one.
  void release();

 private:
  static constexpr int numbers_[] = {SIGINT, SIGTERM, SIGHUP};

  sigset_t signals_{}, mask_{};
  struct sigaction before_[sizeof numbers_ / sizeof *numbers_]{};
  bool held_ = false;
};

}  // namespace egocal::tools
