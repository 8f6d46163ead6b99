// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the supervisor decides when a process ends. No clock and no processes here.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace egocal::tools {

/// A process to be kept alive.
struct Program {
  std::string name;  ///< also of its output file
  std::vector<std::string> command;
  bool ends_all = false;  ///< when it ends with 0 the others are ended too (the player at the end of its log)
  bool foreground = false;  ///< keeps the terminal; when it ends, all end (the monitor)
};

struct RestartOptions {
  /// Pause before a restart: doubled with each death soon after its start, up to the longest. A cause that
  /// lasts for hours (no network, a full disk) costs one start in five seconds.
  std::chrono::milliseconds first_back_off{200}, longest_back_off{5000};
  /// A process that has lived this long has started well; its next death counts as a first one.
  std::chrono::milliseconds started_well{3'000};
};

/// Exit codes after which no restart helps, unless the program has once started well.
inline constexpr int wrong_usage = 2, exec_failed = 127;

/// Decides about the restarts of one process.
class Restarts {
 public:
  enum class Next {
    finished,  ///< it ended as it should, and with it everything
    hopeless,  ///< no restart helps: everything ends
    again,     ///< after pause()
  };

  explicit Restarts(const RestartOptions& options) : options_(options) {}

  /// exit_code: negative where a signal killed it. lived: since its start.
  Next ended(const Program& program, int exit_code, std::chrono::milliseconds lived);
  /// The process could not be started for the moment.
  void not_started() { pause_after(std::chrono::milliseconds{0}); }
  std::chrono::milliseconds pause() const { return pause_; }
  bool pauses_longest() const { return pause_ == options_.longest_back_off; }

 private:
  void pause_after(std::chrono::milliseconds lived);

  RestartOptions options_;
  std::chrono::milliseconds pause_{0};
  bool started_well_ = false;  ///< at least once
};

}  // namespace egocal::tools
