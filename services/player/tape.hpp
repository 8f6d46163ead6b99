// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <regex>
#include <string>

#include "egocal/bus/log_file.hpp"

namespace egocal::services {

struct TapeOptions {
  double start = 0;           ///< begins so far into the log [s]
  std::optional<double> end;  ///< ends so far into the log [s]
  /// Regular expression: only these channels are played. Empty: all except those that egocal itself sends on
  /// (EGOCAL_*), because recorded answers and acknowledgements would be taken for current ones.
  std::string channel;
  // Study of both: tests/services/player/test_tape.cpp. Events of several sources are not exactly in order. A
  // disorder of up to this is no damage [us].
  /// Events of several sources are not exactly in order: up to this is no damage [us].
  std::int64_t disorder_us = 1'000'000;
  /// If only one neighbouring event can be compared, a longer gap is damage [us].
  std::int64_t longest_gap_us = 3'600'000'000;
};

/// The events of a log that are to be played, in the order of the file. A time that fits neither the event
/// before nor the one after is damaged, and is replaced by the time of the event before. Otherwise a flipped
/// bit could make the player wait for years.
class Tape {
 public:
  /// Throws Error where there is nothing to play.
  Tape(const std::string& file, const TapeOptions& options);

  /// The next event; empty at the end.
  std::optional<bus::LogEvent> next();
  /// Starts again, with the events from this time of the log on [s].
  void rewind(double from);

  std::int64_t begin_us() const { return begin_us_; }  ///< recorded time of the log's first event
  const bus::LogDamage& damage() const { return log_.damage(); }
  std::uint64_t damaged_times() const { return damaged_times_; }  ///< since it began
  std::uint64_t skipped() const { return skipped_; }  ///< events of egocal's own channels, since then
  double part() const;                                ///< of the file that has been read

 private:
  void look_ahead();
  void repair_time();
  bool wanted(const std::string& channel);

  bus::LogReader log_;
  TapeOptions options_;
  std::optional<std::regex> channel_;
  std::deque<bus::LogEvent> ahead_;  ///< read, not yet handed out: three at most
  std::optional<std::int64_t> last_us_;
  std::int64_t begin_us_ = 0;
  double from_ = 0;
  std::uint64_t damaged_times_ = 0, skipped_ = 0;
};

}  // namespace egocal::services
