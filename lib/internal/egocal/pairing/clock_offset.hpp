// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/time_offset_search.hpp"

namespace egocal {

/// Whether an estimate may come into force: options.least_correlation, least_inliers and largest_stddev.
bool is_trusted(const TimeOffset& offset, const ClockOptions& options);

/// Whether two offsets are those of two clocks: a change [s] of which the standard deviation is known [s], by
/// options.least_change and change_sigmas.
bool is_another_clock(double change, double stddev, const ClockOptions& options);

/// What following the offset between two clocks remembers: the newest minutes of both streams. Bounded;
/// continuing from a copy gives the same bits.
struct ClockState {
  struct Stream {
    std::deque<StampedPose> window;  ///< thinned, for the estimates; with the stamps they came with
    std::deque<StampedPose> held;    ///< not released yet, in the order of their stamps
    std::optional<std::int64_t> begin_us, newest_us;  ///< stamps
    std::optional<StampedPose> stray;  ///< far from the others: the next pose shows whether time jumped
  };
  std::array<Stream, 2> streams;
  std::int64_t next_us = 0;            ///< end of the next estimate's window, since the begin of both streams
  std::optional<TimeOffset> newest;    ///< estimate, whether it is in force or not
  std::optional<TimeOffset> in_force;  ///< empty while no estimate was good enough
  bool near = false;                   ///< the next estimate searches near the one in force
  std::uint64_t given_up = 0;          ///< poses dropped: held too long, or stray
  std::uint64_t changes = 0;           ///< of what is in force, the first included
};

/// A pose that may be used now.
struct ReleasedPose {
  Side side;
  StampedPose pose;           ///< b's on the clock of a
  std::uint64_t segment = 0;  ///< number of changes of the clock before it
};

/// Follows the offset of clock b from a, and its drift. Poses are held until an estimate is good enough; from
/// then on they pass at once, b's on the clock of a. Estimated again every half minute over the newest
/// minute. Each estimate is worked out over the poses that follow, a bounded share at each, so that none
/// waits for more than a fraction of a millisecond of work. It comes into force once both streams have gone
/// on by as many poses as it has shares, and by `delay` at least: after 2 s at 100 Hz, 5 s at 10 Hz. The
/// poses held until the first one are then released a few at a time, at each pose that follows. The result
/// depends on the stamps of both streams, not on how they interleave nor on how fast the machine is; until
/// the held poses are released, only after release_held() or finish().
class ClockFollower {
 public:
  /// Uses max_gap and the options of its own stage.
  explicit ClockFollower(const PairingOptions& options);
  ClockFollower(const PairingOptions& options, ClockState state);
  ClockFollower(const ClockFollower& other);
  ClockFollower& operator=(const ClockFollower& other);
  ClockFollower(ClockFollower&&) noexcept = default;
  ClockFollower& operator=(ClockFollower&&) noexcept = default;

  /// Takes the next pose of one stream. Returns the poses that may be used now, in the order of time.
  std::vector<ReleasedPose> push(Side side, const StampedPose& pose);
  /// No pose comes for a while. Returns the held poses that may be used, all at once. What the poses after
  /// them give stays the same, to the bit, where stamps ascend.
  std::vector<ReleasedPose> release_held();
  /// Whether release_held() has any.
  bool can_release() const;
  /// No more poses will come. Works out the estimate that is due, and returns all poses that may be used.
  std::vector<ReleasedPose> finish();
  /// What is added to the stamps of b now [s]; empty while it is looked for.
  std::optional<double> seconds() const;
  const ClockState& state() const { return state_; }

 private:
  bool admit(ClockState::Stream& stream, const StampedPose& pose);
  void restart();
  void begin_search();
  void search_on();
  std::size_t shares() const;
  bool due();
  bool both_reached(std::int64_t since_begin_us) const;
  void conclude(std::int64_t worked_us, std::vector<ReleasedPose>& released);
  void take_force(const TimeOffset& offset, std::int64_t worked_us);
  void release(std::int64_t until_us, std::size_t most, std::vector<ReleasedPose>& released);
  void forget();
  bool may_be_used(const ClockState::Stream& stream, std::int64_t until_us) const;
  std::int64_t common_us() const;
  std::int64_t boundary_us() const;

  ClockOptions options_;
  double max_gap_ = 0;
  ClockState state_;
  std::unique_ptr<TimeOffsetSearch> search_;  ///< a copy begins it again, to the same result
};

}  // namespace egocal
