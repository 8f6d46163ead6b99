// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::services {

struct DriveSampleOptions {
  /// Poses of the slower stream, at whose stamps motions are judged. A diagnosis of this number takes about
  /// 50 ms.
  std::size_t most_poses = 1200;
  /// Poses of the faster stream, which is interpolated there: this many times most_poses. A smaller factor
  /// would cost half of the motions of a sensor of 20 Hz beside one of 10 Hz. The factor covers a sensor of 4
  /// Hz beside one of 1 kHz, whose poses are least_distance_us apart.
  std::size_t most_of_faster = 6;
  /// Poses closer than this are skipped [us]: motions are compared over tenths of seconds and more.
  std::int64_t least_distance_us = 45'000;
  /// Poses are kept or dropped in stretches of this length [us], so that neighbours stay neighbours: several
  /// motions of any stride that is of use.
  std::int64_t stretch_us = 5'000'000;
  /// Newer poses than this are always kept [us], so that a fault shows as soon as it happens.
  std::int64_t recent_us = 20'000'000;
};

/// Everything that a DriveSample remembers.
struct DriveSampleState {
  Trajectory a, b;
  std::int64_t time_offset_us = 0;
  std::optional<std::int64_t> origin_us;  ///< the first stretch begins here and is always kept
  std::int32_t level = 0;                 ///< one stretch in 2^level is kept
  std::optional<Side> begun_anew;
};

/// The poses of one sensor pair that a diagnosis looks at: the whole session in bounded memory. When it is
/// full every second stretch of what is older than recent_us is dropped, the same stretches of both streams.
/// What is kept depends on the poses alone.
class DriveSample {
 public:
  explicit DriveSample(const DriveSampleOptions& options = {}) : options_(options) {}

  void push(Side side, const StampedPose& pose);
  /// The time of the stream ran backwards: its earlier poses belong to another timeline. So do those of the
  /// other stream, unless that one has just started again itself.
  void begin_anew(Side side);
  /// A session starts at this time on the clock of a: drops older poses.
  void begin_session(std::int64_t time_us);
  /// Offset added to the stamps of b [s], so that both streams are thinned at the same instants.
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
