// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/rig/rig.hpp"

namespace egocal {

struct RigMotionsOptions {
  int stride = 1;  ///< instants of the slowest sensor in one motion
  Balance balance;
  /// Poses further apart are not interpolated between [s], and no motion spans a pause between instants that
  /// is longer, unless all are.
  double max_gap = 0.5;
  std::vector<GroundPlane> planes;  ///< one a sensor: planar mode; empty: 3-D
  ScreeningOptions screening;       ///< a motion that is not congruent in one pair is left out of all
};

/// All pairs of a rig, with motions between the same instants for all of them: those of the slowest sensor,
/// the other poses interpolated. The errors of the pairwise answers are then nearly dependent, and the loops
/// close to second order. Trajectories: in the order of time, on one clock.
std::vector<RigPair> rig_motions(std::span<const Trajectory> sensors, const RigMotionsOptions& options = {});

}  // namespace egocal
