// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::services {

/// A pose as it came from the bus.
struct Sample {
  StampedPose pose;
  std::int64_t seq = -1;     ///< -1: not counted
  std::int64_t mono_us = 0;  ///< arrival, CLOCK_MONOTONIC [us]
  bool begins_anew = false;  ///< set by Stream: the first one of a new timeline
};

struct StreamCounts {
  std::int64_t lost = 0;  ///< numbers that never came
  std::int64_t duplicate = 0;
  std::int64_t out_of_order = 0;  ///< too late to be used
  std::int64_t jump = 0;          ///< time or number far off, and nothing followed there
};

/// Puts the messages of one odometry channel in order. Its clock is the time inside the messages.
///
/// - A gap in the numbers is waited for until reorder_window of measured time has gone by.
/// - Time or number far off (more than a second and four periods; 1000 numbers): kept back until three
/// messages in a row go
///   on from there, for one damaged message must not end a session. If time then turns out to run backwards
///   (a log that was started again, a clock that was set), a new timeline begins; nothing of it is lost.
class Stream {
 public:
  explicit Stream(double reorder_window_s);

  /// The samples that are now in order, oldest first.
  std::vector<Sample> push(Sample sample);
  /// Gives up waiting: nothing has come for long.
  std::vector<Sample> flush();
  bool waiting() const { return !early_.empty(); }
  const StreamCounts& counts() const { return counts_; }

 private:
  bool plausible(const Sample& sample) const;
  bool known(std::int64_t time_us) const;
  void release(Sample sample, std::vector<Sample>& out);
  void release_early(std::vector<Sample>& out, bool give_up);
  std::vector<Sample> take_candidates();

  std::int64_t reorder_window_us_;
  std::optional<std::int64_t> newest_us_;
  std::int64_t period_us_ = 0;
  std::optional<std::int64_t> next_seq_;
  std::map<std::int64_t, Sample> early_;  // by number, behind a gap
  std::vector<Sample> candidates_;        // for a jump
  std::array<std::int64_t, 64> recent_{};
  std::size_t recent_next_ = 0;
  StreamCounts counts_;
};

}  // namespace egocal::services
