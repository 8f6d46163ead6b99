// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::services {

struct FollowedClockOptions {
  /// A smaller change of the offset [us] is none: what the estimate of a clock that does not drift does.
  std::int64_t least_change_us = 50;
  /// Offsets that are kept. Where there are more, every second one is dropped; a drift is straight in
  /// between.
  std::size_t most = 512;
  /// An offset that changes by this from one problem to the next [us], and by this part of the time between
  /// them, is that of a clock that was set. Quartz drifts by 1e-4, of which pairing lags behind by 10 ms at
  /// most.
  std::int64_t least_jump_us = 100'000;
  double least_jump_rate = 0.02;
};

/// An offset of clock b from clock a, and since when it has been in force, on the clock of a.
struct OffsetSince {
  std::int64_t time_us = 0;
  std::int64_t offset_us = 0;
};

/// The offsets by which pairing followed the clock of b in this session. With one offset for all of a drive,
/// the poses of a clock that drifts contradict an answer whose motions were paired by the offsets of their
/// own times.
class FollowedClock {
 public:
  explicit FollowedClock(const FollowedClockOptions& options = {}) : options_(options) {}

  /// The offset in force at a time of a [us]. Of equal times the last offset counts; earlier
  /// times are ignored.
  void add(std::int64_t time_us, std::int64_t offset_us);
  void clear() { offsets_.clear(); }
  /// The poses of b with stamps such that the newest offset holds for all of them. Before the first offset
  /// the first one holds, between two it is interpolated. What a clock was set by is left in the stamps:
  /// pairing knows the new offset half a minute or more after it was set, the poses show when.
  Trajectory at_newest_offset(Trajectory b) const;

  const std::vector<OffsetSince>& offsets() const { return offsets_; }
  /// Throws Error where no clock can have been followed so.
  void restore(std::vector<OffsetSince> offsets);

 private:
  std::vector<OffsetSince> without_jumps() const;

  FollowedClockOptions options_;
  std::vector<OffsetSince> offsets_;
};

}  // namespace egocal::services
