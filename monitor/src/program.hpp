// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::monitor {

struct ProgramOptions {
  std::string rig, lcm_url, log;
  double speed = 0;
  bool once = false, follow = false, json = false;
  double timeout_s = 5;
  double duration_s = 0;
  std::string screen = "overview";
  std::string size;
  bool ascii = false, monochrome = false;
  std::string version;
};

/// Runs the monitor to its end; the exit code. Throws Error.
int run(const ProgramOptions& options);

}  // namespace egocal::monitor
