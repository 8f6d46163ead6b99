// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/bus/log_file.hpp"
#include "player/tape.hpp"

namespace egocal::services {

/// Where the player is.
struct Progress {
  bool paused = false;
  double speed = 1;            ///< 0: as fast as everybody keeps up
  double part = 0;             ///< of the log
  double seconds = 0;          ///< into the log
  std::uint64_t messages = 0;  ///< sent
  std::string typed;           ///< a number that is being typed
};

/// What the player tells people, on standard error: lines, and on a terminal one that shows the progress.
class Console {
 public:
  Console();

  /// Prints a line without breaking the line that shows the progress.
  void say(const std::string& line);

  /// Says what has been skipped just now, most_reported times: damage that one read has met is one line, of
  /// however many places.
  void say_damage(const bus::LogDamage& damage, std::uint64_t most_reported);
  /// Takes this much of the damage as reported already.
  void take_as_reported(const bus::LogDamage& damage);

  /// Says what could not be played of the log.
  void report(const std::string& log, const Tape& tape);

  /// Shows the progress, at most once a period, or for the last time.
  void show(const Progress& progress, std::int64_t mono_us, std::int64_t period_us, bool last);

 private:
  bool terminal_ = false, line_open_ = false;
  std::int64_t shown_mono_us_ = 0;
  std::uint64_t reported_regions_ = 0, reported_jumps_ = 0;
  std::uint64_t damage_lines_ = 0;  ///< said of it
};

}  // namespace egocal::services
