// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/problem.hpp"

#include <cmath>

#include "egocal/error.hpp"

namespace egocal {

GroundPlane validated(const GroundPlane& plane) {
  const double norm = plane.normal.norm();
  if (!std::isfinite(plane.distance)) throw Error("ground plane: distance is not finite");
  if (!(std::abs(norm - 1) < 1e-3))
    throw Error("ground plane: expected a normal of length 1, got length " + std::to_string(norm));
  return {plane.normal / norm, plane.distance};
}

DualQuaternion plane_frame(const GroundPlane& plane) {
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), plane.normal);
  return to_dual_quaternion({rotation, plane.distance * plane.normal});
}

DualQuaternion planar_motion(const DualQuaternion& motion, const DualQuaternion& G) {
  return canonical_sign(normalized(conjugate(G) * motion * G));
}

DualQuaternion extrinsic_from_planar(const DualQuaternion& T_p, const DualQuaternion& G_a,
                                     const DualQuaternion& G_b) {
  return canonical_sign(normalized(G_a * T_p * conjugate(G_b)));
}

DualQuaternion planar_from_extrinsic(const DualQuaternion& T, const DualQuaternion& G_a,
                                     const DualQuaternion& G_b) {
  DualQuaternion T_p = conjugate(G_a) * T * G_b;
  T_p.real[1] = T_p.real[2] = 0;
  T_p.dual[0] = T_p.dual[3] = 0;
  return canonical_sign(normalized(T_p));
}

}  // namespace egocal
