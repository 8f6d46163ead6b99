// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "egocal/bus/log_file.hpp"

namespace egocal::bus {

// Study of both: tests/services/player/test_tape.cpp.
struct TimedLogOptions {
  /// Events of several sources are not exactly in order: up to this is no damage [us].
  std::int64_t disorder_us = 1'000'000;
  /// If only one neighbouring event can be compared, a longer gap is damage [us].
  std::int64_t longest_gap_us = 3'600'000'000;
};

/// The events of a log, for what follows their times. A time that fits neither the event before nor the one
/// after is damaged, and is replaced by the time of the event before. Otherwise a flipped bit could make a
/// listener wait for years. A copy reads on by itself, in the same open file. One thread at a time.
class TimedLog {
 public:
  /// Throws Error as LogReader does.
  explicit TimedLog(const std::string& file, const TimedLogOptions& options = {});

  /// The next event with its time, which may be corrected; empty at the end. Throws Error where the file
  /// cannot be read.
  std::optional<LogEvent> next();
  /// Goes back to the first event.
  void rewind();
  /// Moves to a place before every event of this time or a later one (LogReader::seek).
  void seek(std::int64_t time_us);

  const LogDamage& damage() const { return log_.damage(); }       ///< up to two events ahead of next()
  std::uint64_t damaged_times() const { return damaged_times_; }  ///< corrected since the last rewind or seek
  std::uint64_t position() const { return log_.position(); }      ///< bytes read
  std::uint64_t size() const { return log_.size(); }              ///< of the file [bytes]

 private:
  void look_ahead();
  void correct_next_time();
  void begin();

  LogReader log_;
  TimedLogOptions options_;
  std::deque<LogEvent> ahead_;  ///< read, not yet handed out: three at most
  std::optional<std::int64_t> last_us_;
  std::uint64_t damaged_times_ = 0;
};

}  // namespace egocal::bus
