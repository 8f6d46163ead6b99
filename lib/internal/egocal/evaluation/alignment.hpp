// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// Tuning of align().
struct AlignmentOptions {
  double max_gap =
      0.5;  ///< poses of a further apart are not interpolated between [s]: as PairingOptions::max_gap
};

/// Trajectory b laid over a through the extrinsic.
struct Alignment {
  Pose T_world_a_world_b;      ///< pose of b's odometry frame in a's
  Trajectory b_as_a;           ///< poses of sensor a in a's world as b has seen them, at a's clock
  std::size_t compared = 0;    ///< poses of b between two poses of a, at most max_gap apart
  double rms_translation = 0;  ///< of b_as_a against a [m]
  double rms_rotation = 0;     ///< [rad]
};

/// T_world_a_world_b is the least-squares mean of T_world_a_a T_a_b T_b_world_b over all instants that both
/// have: rotations by the largest eigenvector of the sum of their outer products, then translations.
/// time_offset is added to the times of b [s]. Throws Error where the two do not overlap in time.
Alignment align(const Trajectory& a, const Trajectory& b, const Pose& T_a_b, double time_offset = 0,
                const AlignmentOptions& options = {});

}  // namespace egocal
