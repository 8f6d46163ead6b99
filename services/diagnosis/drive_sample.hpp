// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::services {

struct DriveSampleOptions {
  /// Of the stream that has fewer: at its stamps motions are judged. A diagnosis of this number takes some 50
  /// ms.
  std::size_t most_poses = 1200;
  /// Of the other one, which is interpolated there: this many times as much. With fewer a sensor of 20 Hz
  /// beside one of 10 Hz would cost half of the motions; a sensor of 4 Hz may be beside one of 1 kHz, whose
  /// poses are no closer than least_distance_us.
  std::size_t most_of_faster = 6;
  /// Poses closer than this are skipped [us]: motions are compared over tenths of seconds and more.
  std::int64_t least_distance_us = 45'000;
  /// Poses are kept or dropped in stretches of this length [us], so that neighbours stay neighbours: several
  /// motions of any stride that is of use.
  std::int64_t stretch_us = 5'000'000;
  /// The newest poses are kept in any case [us], so that what goes wrong now is seen now.
  std::int64_t recent_us = 20'000'000;
};

/// Everything that a DriveSample remembers.
struct DriveSampleState {
  Trajectory a, b;
  std::int64_t time_offset_us = 0;
  std::optional<std::int64_t> origin_us;  ///< the first stretch begins here and is always kept
  std::int32_t level = 0;                 ///< of 2^level stretches one is kept
  std::optional<Side> begun_anew;
};

/// The poses of one sensor pair that a diagnosis looks at: the whole session in bounded memory. When it is
/// full every second stretch of what is older than recent_us is dropped, the same stretches of both streams.
/// What is kept depends on the poses alone.
class DriveSample {
 public:
  explicit DriveSample(const DriveSampleOptions& options = {}) : options_(options) {}

  void push(Side side, const StampedPose& pose);
  /// The stream's time ran backwards: what came before belongs to another timeline, of the other stream too
  /// unless that one has just started again itself.
  void begin_anew(Side side);
  /// A session that began at this time: older poses are not of it.
  void begin_session(std::int64_t time_us);
  /// Added to the stamps of b: both streams are thinned at the same instants [s].
  void set_time_offset(double seconds);

  const Trajectory& poses(Side side) const { return side == Side::a ? state_.a : state_.b; }

  const DriveSampleState& state() const { return state_; }
  /// Throws Error where no DriveSample can have had this state.
  void restore(DriveSampleState state);

 private:
  Trajectory& of(Side side) { return side == Side::a ? state_.a : state_.b; }
  std::int64_t offset_of(Side side) const { return side == Side::b ? state_.time_offset_us : 0; }
  static bool full(const DriveSampleState& state, const DriveSampleOptions& options);
  bool full() const { return full(state_, options_); }
  void thin();
  void thin(Side side);

  DriveSampleOptions options_;
  DriveSampleState state_;
};

}  // namespace egocal::services
