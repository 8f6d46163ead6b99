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
  /// How many answers are still missing then.
  std::function<int()> awaited{};
  LastAnswersOptions last_answers;
  /// How long ago a process was heard on the bus; nothing: never. Foreground programs are left alone, and so
  /// is a process that was never heard.
  std::function<std::optional<std::chrono::milliseconds>(pid_t)> heard_ago{};
  SilenceOptions silence;
  int lines = -1;  ///< lines from this file descriptor are reported as well; it does not block. -1: none
  /// Asked where `lines` has ended: the file descriptor of whoever writes them from then on; empty: nobody.
  std::function<std::optional<int>()> lines_again;
  /// A foreground program has ended as it should, and with it everything.
  std::function<void()> foreground_ended{};
  std::chrono::milliseconds patience{3000};  ///< that processes have to end before they are killed
};

/// Starts all, restarts what ends, with growing pauses and without a limit, passes SIGINT and
/// SIGTERM on (SIGHUP as SIGTERM), ends all together. With a foreground program SIGTSTP stops us when that
/// has given the terminal back, and the terminal's modes are what they were when it is gone, however it
/// ended. Only wrong usage (exit code 2) and a program that cannot be executed, and a foreground program that
/// fails, end all, where that comes before it has once started well: no restart helps there. A Ctrl-C reaches
/// each process once: only foreground programs share our terminal's process group. Whatever happens to us,
/// SIGKILL included, the others get SIGTERM. Returns 0 when they ended because they should, 1 when something
/// could not be started (reported on standard error). Throws Error where an output file cannot be written
/// before the first program starts; none is started then. Later the output of a process whose file cannot be
/// written goes to /dev/null. The caller ignores SIGPIPE, or a report that nobody reads ends us; the programs
/// do not.
int supervise(const std::vector<Program>& programs, const SupervisorOptions& options);

}  // namespace egocal::tools
