// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "problem/tangent.hpp"

namespace egocal::detail {

/// Tangent vectors of T_a_b for the coordinates people read: t' = t + dt, R' = exp(dtheta) R, both in sensor
/// a's frame. Columns: dt (three), then dtheta. Lengths of q and of dt in the same unit.
inline Matrix86d frame_a_basis(const DualQuaternion& T_a_b) {
  const Pose T = to_pose(T_a_b);
  const Eigen::Vector4d t(0, T.translation.x(), T.translation.y(), T.translation.z());
  const Eigen::Vector4d r = T_a_b.real;
  Matrix86d basis;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector4d unit = Eigen::Vector4d::Unit(i + 1);
    const Eigen::Vector4d half = 0.5 * quaternion_product(unit, r);
    basis.col(i) << Eigen::Vector4d::Zero(), half;  // d = 1/2 t r
    basis.col(i + 3) << half, 0.5 * quaternion_product(t, half);
  }
  return basis;
}

/// The coordinates of `to` seen from `from`: (dt, dtheta).
inline Vector6d frame_a_difference(const Pose& a, const DualQuaternion& to) {
  const Pose b = to_pose(to);
  Vector6d x;
  x << b.translation - a.translation, rotation_log(b.rotation * a.rotation.conjugate());
  return x;
}

inline Vector6d frame_a_difference(const DualQuaternion& from, const DualQuaternion& to) {
  return frame_a_difference(to_pose(from), to);
}

/// The extrinsic reached from `from` by (dt, dtheta).
inline DualQuaternion frame_a_moved(const DualQuaternion& from, const Vector6d& x) {
  const Pose T = to_pose(from);
  return to_dual_quaternion(
      {(rotation_exp(x.tail<3>()) * T.rotation).normalized(), T.translation + x.head<3>()});
}

}  // namespace egocal::detail
