// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the supervisor decides when a process is silent on the bus. No clock and no processes here.
#pragma once

#include <chrono>

namespace egocal::tools {

/// A process that is silent while another one is heard hangs, or somebody has stopped it.
struct SilenceOptions {
  std::chrono::milliseconds silent{5000};   ///< after which it is reported and continued (SIGCONT)
  std::chrono::milliseconds hangs{20'000};  ///< after which it is killed
  /// Another process counts as heard within this time, in which each process sends two statuses.
  std::chrono::milliseconds heard{2500};
};

/// Decides what to do about the silence of one process.
class Silence {
 public:
  enum class Next { nothing, report_heard, report_and_continue, kill };

  /// since: how long ago the process was heard. passed: time since the last call. Silence is counted only
  /// while another process is heard: without a network, and after a machine has slept or all processes were
  /// stopped, all of them are silent.
  Next look(std::chrono::milliseconds since, std::chrono::milliseconds passed, bool another_is_heard,
            const SilenceOptions& options);

 private:
  std::chrono::milliseconds silent_{0};  ///< while others are heard
  bool reported_ = false;                ///< and not over yet
};

}  // namespace egocal::tools
