// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Two frames of one body in one stream, with or without a pattern: each change of the frame is a jump, there
// or back, and always the same one.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

/// Study: 12 simulated drives of 30 s (0.1 %, four kinds of noise) and 30 real pairs, with a third or a tenth
/// of the poses 1 m, 2 deg or 120 deg from the others, by chance or by turns, and two drives of 60 s with a
/// second publisher of 1 to 3 Hz. None is found in these as they are, nor with noise on each pose (1 cm to 1
/// m, four kinds), 5 to 30 % outliers, jumps that last, held values, rounded positions or three frames. A
/// mount that rattles at nearly the rate of the poses is found as well: it has two frames.
struct FrameJumpsOptions {
  std::size_t most = 2000;  ///< single steps that are looked at, for time
  std::size_t run = 100;    ///< of these follow one another; the runs are spread evenly over the drive
  std::size_t least = 24;   ///< steps: fewer may be alike by chance
  std::size_t tries = 32;   ///< steps whose residual is tried as the offset of the frames
  /// Steps are alike within this part of the offset: balls about staying, there and back do not touch.
  double radius = 1.0 / 3;
  /// Least part of the steps within one of the balls: 1, with 5 % outliers 0.87, and where the stream is
  /// interpolated between two frames 0.75 and more. Noise of a pose that is uniform in one direction: 0.69.
  double least_explained = 0.75;
  double least_jumps = 0.1;  ///< of the steps; below, pairing omits the poses as outliers
  /// Poses in a row of the frame that has fewer, in the mean: 1 of a slower publisher, 1.1 to 2 by chance. A
  /// mount that moves between two places stays there for longer.
  double most_in_a_row = 3;
  /// Least part of the jumps following another one that lead to the other frame: 0.95 to 1, by chance 0.5.
  double least_alternating = 0.9;
  /// Median residual of steps that stay, and deviation of the jumps from each other, over the offset: 0.1 %
  /// to 9 %, and 12 % where the noise of a motion is that. In balls that are evenly filled it is 17 % and
  /// more, and 16 % of the steps of a mount that vibrates.
  double most_noise = 0.125;
  double least_part = 1e-2;  ///< the offset over a typical step, lest rounding counts
  /// The offset across the way, over the offset: stamps that are late by turns, or by chance, leave 0.5 to
  /// 4 %, and more where a sensor turns by a radian in a second. Frames a metre apart: 53 to 78 %.
  double across = 0.2;
  /// Along the way: jumps scatter this many times less than their parts of the speed do, which are constant
  /// where the stamps are late.
  double clearly_constant = 2;
};

/// The frame that fewer poses of a stream are of.
struct OtherFrame {
  Side side = Side::a;
  double share = 0;     ///< of the poses
  double distance = 0;  ///< from the frame of the others [m]
  double angle = 0;     ///< [rad]
  double noise = 0;     ///< of steps that stay, or of the jumps, over the offset
  bool certain = true;  ///< late stamps leave no such jumps
};

/// What single steps of the one stream leave of those of the other one at the answer is nothing, the offset
/// of the frames or its inverse, and these two by turns.
std::optional<OtherFrame> jumps_between_frames(const Instants& instants, const Pose& T_a_b,
                                               const FrameJumpsOptions& options = {});

}  // namespace egocal::detail
