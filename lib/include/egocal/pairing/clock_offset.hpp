// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/pairing/time_offset.hpp"

namespace egocal {

/// What following the offset between two clocks remembers: the newest minutes of both streams.
struct ClockState {
  struct Stream {
    std::deque<StampedPose> window;        ///< with the stamps they came with
    std::optional<std::int64_t> begin_us;  ///< first stamp
  };
  std::array<Stream, 2> streams;
  std::int64_t next_us = 0;          ///< time since the beginning of both streams of the next estimate
  std::optional<TimeOffset> newest;  ///< estimate, whether it is in force or not
  std::optional<double> in_force;    ///< [s]; empty while no estimate was good enough
  std::uint64_t given_up = 0;        ///< poses held so long that they were dropped
  std::uint64_t changes = 0;         ///< of what is in force, the first included
};

/// A pose that may be used now, with the offset of its time.
struct ReleasedPose {
  Side side;
  StampedPose pose;
};

/// Follows the offset of clock b from a. Poses are held until an estimate is good enough (it correlates, and
/// its standard deviation is below five milliseconds); from then on they pass at once, b's with the offset
/// added. Estimated anew every half minute over the newest minute; another offset comes into force where it
/// differs by five milliseconds and by four standard deviations. Depends on the stamps of both streams, not
/// on how they interleave, as long as one does not run two minutes ahead.
std::vector<ReleasedPose> follow_clock(ClockState& state, Side side, const StampedPose& pose, double max_gap);

}  // namespace egocal
