// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions that contradict the answer one after the other, again and again: a sensor on a towed part does so
// whenever the vehicle turns in or out, and the poses that are left agree with another place of it.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct ContradictingRunsOptions {
  /// A motion contradicts if the answer leaves this many times the median residual, and this part of its
  /// length, or of its angle.
  double times = 6, of_motion = 0.1;
  /// A rotation contradicts only if the answer also leaves at least this of it [rad]: as large as what users
  /// call wrong.
  double least_rotation = radians_per_degree;
  /// A run lasts longer than a motion by this many instants: one jump is in as many motions as one spans, and
  /// wrong poses are few in a row (WrongPosesOptions::most_in_a_row).
  double least_instants = 8;
  std::size_t least_runs = 3;  ///< one or two are an odometry that was lost
  /// Least part of the time of all motions that the runs last, together. Sensors on trailers that were not
  /// named otherwise: 0.07 to 0.24; 140 clean drives of 25 machines of an independent simulator: none.
  double least_part = 0.05;
  /// Motions of this part of the length are looked at, too: a long one hides a vehicle that turns in for half
  /// a second.
  int shorter = 4;
};

struct ContradictingRuns {
  std::size_t runs = 0;
  double seconds = 0;  ///< that they last, together
  double part = 0;     ///< of the drive
};

/// motions: of instants that are `period` [s] apart.
ContradictingRuns contradicting_runs(const Motions& motions, double period, const Pose& T_a_b,
                                     const ContradictingRunsOptions& options = {});

/// Adds finding mount_moved, uncertain, where there are such runs, and no certain finding explains them.
/// motions: of the instants, sampled so.
void name_contradicting_runs(const Instants& instants, const Motions& motions, const Pose& T_a_b,
                             const MotionSampleOptions& sample, std::vector<Finding>& findings,
                             const ContradictingRunsOptions& options = {});

}  // namespace egocal::detail
