// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with the streams for any extrinsic: one of them is frozen, both are the same, they
// are of one drive in part only, or no streams at all. "Study" is tests/bench/mistake_study.cpp.
#pragma once

#include <vector>

#include "diagnosis/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct StreamCheckOptions {
  std::size_t most = 4000;  ///< steps that are looked at; bounds the cost of a drive of any length
  /// Of the length and of 1: motions that agree better are equal to the digits of their files,
  double same = 1e-9;
  double same_part = 1e-4;  ///< where they also agree to this part of the motion
  double rounding =
      1e-13;  ///< of the length and of 1: a motion that is smaller is none, to a hundred roundings
  std::size_t least = 20;      ///< equal steps, fewer are chance
  double least_frozen = 0.05;  ///< of what the other stream travels meanwhile; pairing rejects it anyway
  std::size_t windows = 10;    ///< of the drive; a part of another drive is found to a tenth
  /// Angles of a window agree where they differ by less than this part, and may disagree from there on: noise
  /// of a tenth of every motion stays below 0.2 in the study, unlike drives are above 0.3.
  double agree = 0.25, disagree = 0.15;
  double step = 4;  ///< least ratio, of these parts and of the angles, to windows that agree
  /// Part of the motions that agree as the other windows do, by chance: more than a third, and wrong poses
  /// explain the rest (two of three motions have an end at one where a third of the poses are wrong).
  double most_agreeing = 1.0 / 3;
  /// Lengths of the motions agree where their ratio scatters by less than this part of the lengths themselves
  /// (median deviations of the logarithms): an odometry measures how far it travels well where it hardly
  /// turns. 5,313 pairs of unrelated drives, of 14 simulated kinds and real ones, are above 0.29; sensors of
  /// one train in noise that hides its curves are at 0.01 to 0.2.
  double lengths_agree = 0.25;
  double least_turning = 0.3;  ///< of the typical motion; a window that turns less says nothing
  double flat = 1e-6;          ///< of the longest extent: a coordinate that changes by less never changes
  double least_tilt = 0.0175;  ///< of a stream with a flat coordinate: a degree [rad]; level ground is within
  /// An answer this close to the identity, or within three standard deviations of it [rad, m]: frames of two
  /// sensors that are bolted to one vehicle differ by more, except for stereo cameras.
  double parallel = 0.0087, close = 0.2;
  double known_rotation = 0.0175,
         known_translation = 0.3;  ///< standard deviations up to here show it [rad, m]
  /// Half of the motions agree to less [rad, and as a part of their length]: rounding, and a hundredth of
  /// what two sensors leave.
  double of_rounding = 1e-5;
  /// A stream with a flat coordinate that turns out of that plane by less was given in two dimensions [rad].
  double level = 1e-5;
  /// The other one tilts where it does by more than least_tilt in this part of the drive, and by more than so
  /// many times what both streams differ by in turning in the plane: noise of rotations has no plane.
  std::size_t parts = 32;
  double over_noise = 3;
};

/// Certain: the poses of both sensors are the same.
Finding same_stream();

/// missing_a, missing_b (no positions or no rotations), flat_a, flat_b, frozen_a, frozen_b, same_stream
/// (uncertain where it was rounded), samples.
std::vector<Finding> check_streams(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                   const StreamCheckOptions& options = {});

/// Both streams travel alike, by more than chance: they are of one drive, whatever their rotations say. Where
/// the speed does not change this cannot be known.
bool travel_together(const Motions& motions, const StreamCheckOptions& options = {});

/// unrelated, with the time from which on: part of the drive does not turn together, the rest does.
std::vector<Finding> unrelated_part(const Motions& motions, const StreamCheckOptions& options = {});

/// same_stream, uncertain: the answer is the identity, as far as it is known. Both streams are then of one
/// frame; where poses were moved to the vehicle's frame before, the answer is not the mounting.
std::vector<Finding> in_one_frame(const Answered& answered, const StreamCheckOptions& options = {});

/// same_stream, uncertain: the motions agree to rounding. One stream was made from the other, and whatever
/// made it is the answer; or both were simulated without noise.
std::vector<Finding> made_from_each_other(const Fit& fit, const StreamCheckOptions& options = {});

}  // namespace egocal::detail
