// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <regex>
#include <string>

#include "egocal/bus/log_file.hpp"
#include "egocal/bus/timed_log.hpp"

namespace egocal::services {

struct TapeOptions {
  double start = 0;           ///< begins so far into the log [s]
  std::optional<double> end;  ///< ends so far into the log [s]
  /// Regular expression: only these channels are played. Empty: all except those that egocal itself sends on
  /// (EGOCAL_*), because recorded answers and acknowledgements would be taken for current ones.
  std::string channel;
  bus::TimedLogOptions times{};
};

/// The events of a log that are to be played, in the order of the file, with times that a TimedLog believes.
/// A copy plays on by itself, from the same open file.
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
  std::uint64_t damaged_times() const { return log_.damaged_times(); }  ///< since it began
  std::uint64_t skipped() const { return skipped_; }  ///< events of egocal's own channels, since then
  double part() const;                                ///< of the file that has been read

 private:
  bool wanted(const std::string& channel);

  bus::TimedLog log_;
  TapeOptions options_;
  std::optional<std::regex> channel_;
  std::int64_t begin_us_ = 0;
  double from_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace egocal::services
