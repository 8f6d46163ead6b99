// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Checks one pose, as a file or an array has it, against the limits of egocal/limits.hpp.
#pragma once

#include <Eigen/Core>
#include <string>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

struct CheckedPose {
  DualQuaternion pose;
  std::string reason;  ///< why these numbers are no pose; empty where they are one
};

/// The reason of a pose that a program wrote where it had none.
inline constexpr const char* zero_quaternion = "quaternion: is zero";

/// Position [m] and quaternion (w x y z) within 1 % of unit length, as a unit dual quaternion.
CheckedPose checked_pose(const Eigen::Vector3d& position, const Eigen::Vector4d& wxyz);

}  // namespace egocal::detail
