// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with the streams for any extrinsic: one of them is frozen or lacks a half, both are the same,
// or they are no streams at all. "Study" is tests/bench/mistake_study.cpp.
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/one_drive.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct StreamCheckOptions {
  std::size_t most = 4000;  ///< steps that are looked at; bounds the cost of a drive of any length
  /// Largest difference of equal motions, as a part of the length and of 1: those that agree better are equal
  /// to the digits of their files,
  double same = 1e-9;
  double same_part = 1e-4;  ///< where they also agree to this part of the motion
  double rounding =
      1e-13;  ///< of the length and of 1: a motion that is smaller is none, to a hundred roundings
  std::size_t least = 20;      ///< equal steps, fewer are chance
  double least_frozen = 0.05;  ///< of what the other stream travels meanwhile; pairing rejects it anyway
  double flat =
      1e-6;  ///< of what the other stream does: positions or rotations that change by less never change
  double least_tilt = 0.0175;  ///< of the other stream, where rotations never change: a degree [rad]
  /// An answer this close to the identity, or within three standard deviations of it [rad, m]: frames of two
  /// sensors that are bolted to one vehicle differ by more, except for stereo cameras.
  double parallel = 0.0087, close = 0.2;
  double known_rotation = 0.0175,
         known_translation = 0.3;  ///< standard deviations up to here show it [rad, m]
  /// Half of the motions agree to less [rad, and as a part of their length]: rounding, and a hundredth of
  /// what two sensors leave.
  double of_rounding = 1e-5;
  bool metres = true;  ///< what the lengths of the streams are in, or units of their own
};

/// Certain: the poses of both sensors are the same.
Finding same_stream();

/// missing_a, missing_b (no positions or no rotations), flat_a, flat_b, frozen_a, frozen_b, mixed_frames_a,
/// mixed_frames_b (of two odometries), same_stream (uncertain where it was rounded), samples.
std::vector<Finding> check_streams(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                   const StreamCheckOptions& options = {});

/// same_stream, uncertain: the answer is the identity, as far as it is known. Both streams are then of one
/// frame; where poses were moved to the vehicle's frame before, the answer is not the mounting.
std::vector<Finding> in_one_frame(const Answered& answered, const StreamCheckOptions& options = {});

/// same_stream, uncertain: the motions agree to rounding. One stream was made from the other, and whatever
/// made it is the answer; or both were simulated without noise.
std::vector<Finding> made_from_each_other(const Fit& fit, const StreamCheckOptions& options = {});

}  // namespace egocal::detail
