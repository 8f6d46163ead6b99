// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/signalfd.h>

#include <csignal>
#include <optional>

namespace egocal::tools {

/// The signals to a supervisor (SIGINT, SIGTERM, SIGHUP, SIGCHLD, and SIGTSTP where a program has the
/// terminal), which are read instead of handled while this object exists. Of one thread.
class ProgramSignals {
 public:
  /// Throws Error.
  explicit ProgramSignals(bool has_terminal);
  ~ProgramSignals();
  ProgramSignals(const ProgramSignals&) = delete;
  ProgramSignals& operator=(const ProgramSignals&) = delete;

  /// A file descriptor that is readable while a signal waits.
  int descriptor() const { return descriptor_; }
  /// The next signal; empty: none waits.
  std::optional<signalfd_siginfo> next();
  /// What the programs have blocked: as the caller, who may hold signals back for us.
  const sigset_t& mask_of_programs() const { return programs_mask_; }

 private:
  sigset_t old_mask_{}, programs_mask_{};
  int descriptor_ = -1;
};

}  // namespace egocal::tools
