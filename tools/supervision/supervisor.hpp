// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
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

struct SupervisorOptions {
  std::string output_dir;  ///< NAME.out in it; empty: output goes where ours goes
  bool quiet = false;      ///< the terminal is somebody else's: what we have to say goes to up.out there
  std::chrono::milliseconds first_back_off{200}, longest_back_off{5000};
  int most_quick_deaths = 10;                ///< in a row, each within a second of its start: given up
  int most_starts_a_minute = 30;             ///< of one process: given up
  std::chrono::milliseconds settle{1500};    ///< after the player's end, for the last answers
  std::chrono::milliseconds patience{3000};  ///< that processes have to end before they are killed
};

/// Starts all, restarts what dies with growing pauses, passes SIGINT and SIGTERM on (SIGHUP as SIGTERM), ends
/// all together. A Ctrl-C reaches each process once: only foreground programs share our terminal's process
/// group. Whatever happens to us, SIGKILL included, the others get SIGTERM. Returns 0 when they ended because
/// they should, 1 when something could not be kept alive (said on standard error). Throws Error where an
/// output file cannot be written or nothing can be started; nothing is left running then.
int supervise(const std::vector<Program>& programs, const SupervisorOptions& options);

}  // namespace egocal::tools
