// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Faults of the clock that stamps a stream, by its times beside the clock of this host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace egocal::bus {

/// Study: tests/bus/test_stream_clock.cpp.
struct StreamClockOptions {
  /// Times of a stream are compared with the clock after this long [us]: a wrong unit is off by a thousand.
  std::int64_t pace_window_us = 3'000'000;
  /// Messages with the time of the one before: five are no accident.
  std::int64_t most_at_same_time = 5;
  /// Time that runs ahead of the clock by more from one message to the next has jumped [us]. What pairing
  /// does not believe at once either (StreamOptions::largest_jump).
  std::int64_t largest_jump_us = 1'000'000;
  /// Messages in a row that confirm a jump: one may be damaged, or late.
  std::size_t confirmations = 3;
  /// A jump ahead is one of a clock that ran as fast as ours for this long before [us], to this part: a log
  /// that is played faster leaps over its gaps.
  std::int64_t steady_us = 1'000'000;
  double steady_part = 0.2;
  /// Messages that are remembered: several times what a player sends again.
  std::size_t most_remembered = 256;
};

/// What is looked at of a message.
struct Stamp {
  std::int64_t time_us = 0;  ///< its own
  std::int64_t mono_us = 0;  ///< its arrival, by the loop's clock
  std::int64_t seq = -1;     ///< -1: not counted
  std::array<double, 3> position{};
};

struct ClockFault {
  std::string reason;  ///< "clock jumps", "the same time again", "unit of time"
  std::string cure;    ///< with the values that were seen
};

/// One stream. What a network repeats or delays, and a player sends again or begins anew, is no fault.
class StreamClock {
 public:
  explicit StreamClock(const StreamClockOptions& options = {}) : options_(options) {}

  /// The fault that this message completes.
  std::optional<ClockFault> hear(const Stamp& stamp);

 private:
  struct Pace {
    Stamp begin;
    std::int64_t steps = 0, leaps = 0;  ///< since then
  };

  bool known(const Stamp& stamp) const;
  void remember(const Stamp& stamp);
  bool leaps(const Stamp& from, const Stamp& to) const;
  bool steady() const;
  std::optional<ClockFault> same_time(const Stamp& stamp);
  std::optional<ClockFault> jump(const Stamp& stamp);
  std::optional<ClockFault> unit(const Stamp& before, const Stamp& stamp);

  StreamClockOptions options_;
  std::optional<Stamp> before_;          ///< the message before this one
  std::optional<Stamp> first_, newest_;  ///< of the times that run on
  std::vector<Stamp> apart_;             ///< in a row, which do not continue the newest and may be a jump
  std::vector<Stamp> remembered_;
  std::size_t remembered_next_ = 0;
  std::optional<Pace> pace_;
  std::int64_t at_same_time_ = 0, same_time_in_all_ = 0;
};

}  // namespace egocal::bus
