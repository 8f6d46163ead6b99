// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "supervision/last_answers.hpp"
#include "supervision/restarts.hpp"
#include "supervision/silence.hpp"

namespace egocal::tools {

struct SupervisorOptions {
  std::string output_dir;  ///< NAME.out in it; empty: output goes where ours goes
  bool quiet = false;      ///< the terminal belongs to a foreground program: messages go to up.out there
  RestartOptions restarts;
  /// The same death is reported again after this time.
  std::chrono::milliseconds repeat_report{60'000};
  std::chrono::milliseconds settle{1500};  ///< after the player's end, for the last answers
  /// How many answers are still missing. Asked at the player's end for the first time, and again from
  /// `settle` on.
  std::function<int()> awaited{};
  /// The process that counts them, whose work counts as that of the programs; -1: none runs.
  std::function<pid_t()> counts_awaited{};
  LastAnswersOptions last_answers;
  /// How long ago a process was heard on the bus; nothing: never. Foreground programs are left alone, and so
  /// is a process that was never heard.
  std::function<std::optional<std::chrono::milliseconds>(pid_t)> heard_ago{};
  SilenceOptions silence;
  /// For how long a process may be silent while it computes, by what it said last (bus::announced_silence).
  std::function<std::chrono::milliseconds(pid_t)> may_be_silent{};
  int lines = -1;  ///< lines from this file descriptor are reported as well; it does not block. -1: none
  /// Asked where `lines` has ended: the file descriptor of whoever writes them from then on; empty: nobody.
  std::function<std::optional<int>()> lines_again;
  /// A foreground program has ended as it should, and with it everything.
  std::function<void()> foreground_ended{};
  std::chrono::milliseconds patience{3000};  ///< that processes have to end before they are killed
};

/// Starts all programs, and restarts those that end: without a limit, with growing pauses.
/// - SIGINT and SIGTERM (and SIGHUP, as SIGTERM) are passed on and end all programs. A Ctrl-C reaches each
///   process once, because only foreground programs share the process group of the terminal.
/// - SIGTSTP stops this process after the foreground program has released the terminal. The modes of the
///   terminal are restored when the foreground program ends, however it ends.
/// - Wrong usage (exit code 2), a program that cannot be executed, and a foreground program that fails end
///   all programs, unless the program has started well before: a restart would not help.
/// - If this process dies, SIGKILL included, the programs receive SIGTERM.
/// Returns 0 after a regular end, and 1 if a program could not be started (reported on standard error).
/// Throws Error if an output file cannot be opened before the first program starts; then none is started. If
/// it cannot be opened later, the output of that program goes to /dev/null. The caller must ignore SIGPIPE:
/// otherwise a report to a closed pipe ends this process. The programs do not inherit that.
int supervise(const std::vector<Program>& programs, const SupervisorOptions& options);

}  // namespace egocal::tools
