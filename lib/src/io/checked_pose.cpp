// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/checked_pose.hpp"

#include <Eigen/Geometry>
#include <string>

#include "egocal/limits.hpp"

namespace egocal::detail {

CheckedPose checked_pose(const Eigen::Vector3d& position, const Eigen::Vector4d& wxyz) {
  if (!position.allFinite()) return {{}, "position: expected finite numbers"};
  if (!plausible_distance(position.cwiseAbs().maxCoeff())) return {{}, "position: expected less than 1e9 m"};
  if (!wxyz.allFinite()) return {{}, "quaternion: expected finite numbers"};
  const double norm = wxyz.norm();
  if (!(norm > 1e-6)) return {{}, zero_quaternion};
  if (!plausible_norm(norm)) return {{}, "quaternion: expected length 1, got " + std::to_string(norm)};
  return {to_dual_quaternion({Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized(), position}),
          ""};
}

}  // namespace egocal::detail
