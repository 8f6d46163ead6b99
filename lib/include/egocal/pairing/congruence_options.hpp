// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Every number that the test of screw congruence decides by. "Study" is tests/bench/outlier_study.cpp: wrong
// poses of seven kinds in real and simulated drives; docs/accuracy.md, "Gross outliers", has its table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

namespace egocal {

/// Tuning of the test whether two motions are screw congruent.
struct CongruenceOptions {
  /// Below this angle a motion has no screw axis to slide along [rad]. 1.1 degrees: a noise of a tenth of a
  /// degree turns the axis of smaller motions by more than five degrees.
  double least_turn = 0.02;
  /// Differences of angles and lengths that are rounding alone [rad, m]: six printed digits of a quaternion,
  /// five of a position. They keep exact streams from being measured in standard deviations of zero.
  double angle_floor = 1e-6, length_floor = 1e-5;
  /// Newest motions that show what is typical: 100 s at 10 Hz, so that a drive from a car park onto a road
  /// is judged by the road.
  std::size_t memory = 1024;
  /// Motions before the first estimate: a quartile of each half of them has six values on either side. Study:
  /// wrong poses among the first two dozen are found when these are screened again.
  std::size_t first_estimate = 24;
  /// Motions between estimates while the memory fills, and once it is full: one sixteenth of it is new then.
  /// Measured: the same answers as with 16 throughout, 940 -> 370 ms of pairing for 100,000 poses.
  std::uint64_t estimate_every = 16, estimate_every_when_full = 64;
  /// One of this number of motions of doubtful poses is remembered: they may be wrong, or the beginning of
  /// noisier seconds, which the estimate must follow after a while.
  std::uint64_t doubtful_remembered = 8;
  /// Noise that grows with the motion is at most this part of it: with more no odometry is left to compare.
  double most_growing = 0.2;
  /// No odometry differs by more from one pose to the next, however noisy it is just now: an angle [rad], and
  /// lengths as a multiple of the mean of the longer half of the motions. Study: jumps within noisy seconds.
  double gross_angle = 20 * std::numbers::pi / 180, gross_lengths = 10;
  /// How large the lever arm between the sensors may be [m]. It explains why the lengths of their motions
  /// differ while the vehicle turns. 10 m cover cars and trucks; trailers, cranes and ships need more.
  double longest_lever_arm = 10;
};

}  // namespace egocal
