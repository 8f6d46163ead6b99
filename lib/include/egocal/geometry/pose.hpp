// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "egocal/layout.hpp"

namespace egocal {

/// Eigen's quaternion, unaligned: its layout does not depend on compile flags (egocal/layout.hpp).
using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

/// A rigid displacement T_a_b: p_a = rotation * p_b + translation. The rotation is a unit quaternion.
struct Pose {
  Rotation rotation = Rotation::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
};
EGOCAL_SAME_LAYOUT(Pose)

/// T_a_c = T_a_b * T_b_c.
Pose operator*(const Pose& T_a_b, const Pose& T_b_c);
/// The inverse, T_b_a.
Pose inverse(const Pose& T_a_b);
Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b);

/// Rotation by the vector's length about its direction [rad].
Rotation rotation_exp(const Eigen::Vector3d& rotation_vector);
/// The rotation vector of the shorter way round, its length in [0, pi] [rad].
Eigen::Vector3d rotation_log(const Rotation& rotation);

/// Roll, pitch, yaw with R = Rz(yaw) Ry(pitch) Rx(roll) [rad]: pitch in [-pi/2, pi/2], roll and yaw in
/// [-pi, pi]. They make R to rounding, also at a pitch of +-pi/2, where roll and yaw are not unique.
Eigen::Vector3d roll_pitch_yaw(const Rotation& rotation);

}  // namespace egocal
