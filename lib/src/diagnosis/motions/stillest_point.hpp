// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What lever arm times rotation does not explain of the motions of a body.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

/// One motion of a body, in its own frame.
struct BodyMotion {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};

Eigen::Matrix3d rotation_of(const DualQuaternion& motion);

/// How the point of the body that goes the shortest way in all is displaced in each motion. A point at c is
/// displaced by t + (R - 1) c.
std::vector<Eigen::Vector3d> at_stillest_point(const std::vector<BodyMotion>& motions);

}  // namespace egocal::detail
