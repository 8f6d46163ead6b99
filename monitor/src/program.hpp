// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
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
  // What a person notices; the load that they cause is in docs/monitor.md.
  std::int64_t drain_us = 50'000;      ///< messages are processed this often [us]: batches keep the load low
  std::int64_t redraw_us = 100'000;    ///< between redraws [us]: ten a second
  std::int64_t tick_us = 200'000;      ///< time passes for the model this often [us]
  std::int64_t notice_us = 8'000'000;  ///< the outcome of a key is shown this long [us]
};

/// Runs the monitor to its end; the exit code. Throws Error.
int run(const ProgramOptions& options);

}  // namespace egocal::monitor
