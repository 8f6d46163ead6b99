// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

/// y = a X c with c = b^-1 is the target's pose as one sample sees it: linear in X. All samples should see
/// the same one.
struct SeenTarget {
  Eigen::Matrix4d real = Eigen::Matrix4d::Zero();  ///< y.real = real X.real
  Eigen::Matrix4d dual = Eigen::Matrix4d::Zero();  ///< y.dual = dual X.real + real X.dual

  /// The target as this sample sees it with this X.
  DualQuaternion with(const DualQuaternion& X) const {
    return {real * X.real, dual * X.real + real * X.dual};
  }
};

/// The pose as seen from a frame that is shifted by -shift [m].
inline DualQuaternion shifted(const DualQuaternion& pose, const Eigen::Vector3d& shift) {
  QuaternionVector t;
  t << 0, shift;
  return {pose.real, pose.dual + 0.5 * quaternion_product(t, pose.real)};
}

}  // namespace egocal::detail
