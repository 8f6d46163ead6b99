// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

/// The ground seen from a sensor in Hesse normal form: normal . x = distance, the unit normal pointing up, so
/// distance is minus the mounting height [m].
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double distance = 0;
};
EGOCAL_SAME_LAYOUT(GroundPlane)

/// Throws Error where the normal is not of length one (to 1e-3; it is then normalised) or a value is not
/// finite.
GroundPlane validated(const GroundPlane& plane);

/// G of (23): the pose of the plane's frame (z up, origin on the ground below the sensor) in the sensor's
/// frame, with the least rotation that takes e_z to the normal.
DualQuaternion plane_frame(const GroundPlane& plane);

/// V_p = G^-1 V G of (24a), (24b): the motion as seen from the plane's frame.
DualQuaternion planar_motion(const DualQuaternion& motion, const DualQuaternion& G);
/// T = G_a T_p G_b^-1 of (27), T_p the pose of plane frame b in plane frame a.
DualQuaternion extrinsic_from_planar(const DualQuaternion& T_p, const DualQuaternion& G_a,
                                     const DualQuaternion& G_b);
/// T_p = G_a^-1 T G_b of (24c), with the parts (25) sets to zero set to zero.
DualQuaternion planar_from_extrinsic(const DualQuaternion& T, const DualQuaternion& G_a,
                                     const DualQuaternion& G_b);

enum class Mode {
  spatial,  ///< six degrees of freedom
  planar,   ///< x, y and yaw; the rest from the ground planes (III-E)
};

/// All that a solver needs to know of one sensor pair.
struct Problem {
  Mode mode = Mode::spatial;
  GroundPlane plane_a, plane_b;    ///< planar mode: the blocks hold motions seen from these planes (24)
  Balance balance;                 ///< of rotation and translation
  std::vector<Statistics> blocks;  ///< consecutive; their sum is the whole
  /// Where the answer is taken from in directions that the motions do not show.
  std::optional<DualQuaternion> prior;
};
EGOCAL_SAME_LAYOUT(Problem)

/// Q of (16), all blocks together.
Matrix8d cost_matrix(const Problem& problem);

}  // namespace egocal
