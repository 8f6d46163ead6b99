// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Jumps that last: tracking is lost and found again elsewhere, so one step is no motion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Study: tests/lib/test_time_offset.cpp.
struct LastingJumpOptions {
  double outlier = 8;  ///< typical differences between a step and the mean of its neighbours
  /// Least difference of a jump, as a part of the larger neighbour: a sensor that begins to move, or turns a
  /// corner, differs by less.
  double least_part = 1;
  /// Largest part of the steps. If more look like jumps, the stream is one of steps: an odometry that repeats
  /// its poses.
  double most = 0.05;
  double angle_floor = 1e-3, length_floor = 1e-3;  ///< differences that matter to no clock [rad, m]
};

/// The step from one pose to the next one, against the mean velocity of the steps before and after it.
struct StepDifference {
  double angle = 0, length = 0;                      ///< [rad, m]
  double neighbour_angle = 0, neighbour_length = 0;  ///< of the larger neighbour, in the same time
  bool known = false;
};
/// Difference of the step from pose i; unknown at both ends, and beside a gap of more than max_gap_us.
StepDifference step_difference(const Trajectory& trajectory, std::size_t i, std::int64_t max_gap_us);

/// The trajectory with the mean velocity of both neighbours in place of each step that is a lasting jump;
/// later poses follow. differences: of each step.
Trajectory without_lasting_jumps(const Trajectory& trajectory, const std::vector<StepDifference>& differences,
                                 const LastingJumpOptions& options = {});

}  // namespace egocal::detail
