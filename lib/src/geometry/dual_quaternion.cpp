// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/geometry/dual_quaternion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace egocal {

namespace {

/// The scalar product, summed in one order whatever the width of the processor's vectors: normalised poses
/// have the same bits in a build for any processor, and those of detail::motions_between().
double dot(const QuaternionVector& p, const QuaternionVector& q) {
  return (p[0] * q[0] + p[2] * q[2]) + (p[1] * q[1] + p[3] * q[3]);
}

}  // namespace

QuaternionVector quaternion_product(const QuaternionVector& p, const QuaternionVector& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

QuaternionVector quaternion_conjugate(const QuaternionVector& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

QuaternionMatrix left_matrix(const QuaternionVector& p) {
  QuaternionMatrix M;
  M << p[0], -p[1], -p[2], -p[3],  //
      p[1], p[0], -p[3], p[2],     //
      p[2], p[3], p[0], -p[1],     //
      p[3], -p[2], p[1], p[0];
  return M;
}

QuaternionMatrix right_matrix(const QuaternionVector& q) {
  QuaternionMatrix M;
  M << q[0], -q[1], -q[2], -q[3],  //
      q[1], q[0], q[3], -q[2],     //
      q[2], -q[3], q[0], q[1],     //
      q[3], q[2], -q[1], q[0];
  return M;
}

Vector8d DualQuaternion::vec() const {
  Vector8d q;
  q << real, dual;
  return q;
}

DualQuaternion DualQuaternion::from_vec(const Vector8d& q) {
  return {q.head<4>(), q.tail<4>()};
}

DualQuaternion operator*(const DualQuaternion& p, const DualQuaternion& q) {
  return {quaternion_product(p.real, q.real),
          quaternion_product(p.real, q.dual) + quaternion_product(p.dual, q.real)};
}

DualQuaternion operator-(const DualQuaternion& q) {
  return {-q.real, -q.dual};
}

DualQuaternion conjugate(const DualQuaternion& q) {
  return {quaternion_conjugate(q.real), quaternion_conjugate(q.dual)};
}

Matrix8d left_matrix(const DualQuaternion& p) {
  Matrix8d M = Matrix8d::Zero();
  M.topLeftCorner<4, 4>() = M.bottomRightCorner<4, 4>() = left_matrix(p.real);
  M.bottomLeftCorner<4, 4>() = left_matrix(p.dual);
  return M;
}

Matrix8d right_matrix(const DualQuaternion& q) {
  Matrix8d M = Matrix8d::Zero();
  M.topLeftCorner<4, 4>() = M.bottomRightCorner<4, 4>() = right_matrix(q.real);
  M.bottomLeftCorner<4, 4>() = right_matrix(q.dual);
  return M;
}

DualQuaternion normalized(const DualQuaternion& q) {
  const double norm = std::sqrt(dot(q.real, q.real));
  // beyond, the squares that the length is made of overflow or vanish
  if (!(norm > 1e-100 && norm < 1e100)) {
    const QuaternionVector nothing = QuaternionVector::Constant(std::numeric_limits<double>::quiet_NaN());
    return {nothing, nothing};
  }
  const QuaternionVector real = q.real / norm;
  const QuaternionVector dual = q.dual / norm;
  return {real, dual - dot(real, dual) * real};
}

DualQuaternion canonical_sign(const DualQuaternion& q) {
  for (int i = 0; i < 4; ++i) {
    if (q.real[i] > 0) return q;
    if (q.real[i] < 0) return -q;
  }
  return q;
}

DualQuaternion to_dual_quaternion(const Pose& T) {
  const QuaternionVector real(T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z());
  const QuaternionVector t(0, T.translation.x(), T.translation.y(), T.translation.z());
  return canonical_sign(normalized({real, 0.5 * quaternion_product(t, real)}));
}

Pose to_pose(const DualQuaternion& q) {
  const DualQuaternion unit = canonical_sign(normalized(q));
  const QuaternionVector t = 2 * quaternion_product(unit.dual, quaternion_conjugate(unit.real));
  return {Eigen::Quaterniond(unit.real[0], unit.real[1], unit.real[2], unit.real[3]), t.tail<3>()};
}

double rotation_angle(const QuaternionVector& q) {
  return 2 * std::atan2(q.tail<3>().norm(), std::abs(q[0]));
}

double rotation_angle(const DualQuaternion& q) {
  return rotation_angle(q.real);
}

double translation_length(const DualQuaternion& q) {
  return 2 * q.dual.norm();
}

Screw screw_of(const DualQuaternion& q) {
  const DualQuaternion unit = canonical_sign(q);
  const double sine = unit.real.tail<3>().norm();
  const double angle = 2 * std::atan2(sine, unit.real[0]);
  // real scalar cos(angle/2), dual scalar -slide/2 sin(angle/2)
  if (sine < 1e-9) return {angle, 2 * unit.dual.norm()};
  return {angle, -2 * unit.dual[0] / sine};
}

DualQuaternion interpolate(const DualQuaternion& p, const DualQuaternion& q, double s) {
  if (s <= 0) return p;
  if (s >= 1) return q;
  // p (p^-1 q)^s, the power along the screw of the motion from p to q
  const DualQuaternion motion = canonical_sign(conjugate(p) * q);
  const Eigen::Vector3d v = motion.real.tail<3>();
  const double sine = v.norm();
  DualQuaternion part;
  if (sine < 1e-9) {
    // nearly no rotation: first order in the angle, straight in the translation
    part.real << 1, s * v;
    part.real.normalize();
    const Pose whole = to_pose(motion);
    part.dual =
        0.5 * quaternion_product(QuaternionVector(0, s * whole.translation.x(), s * whole.translation.y(),
                                                  s * whole.translation.z()),
                                 part.real);
  } else {
    const double half_angle = std::atan2(sine, motion.real[0]);
    const double half_slide = -motion.dual[0] / sine;
    const Eigen::Vector3d axis = v / sine;
    const Eigen::Vector3d moment = (motion.dual.tail<3>() - half_slide * motion.real[0] * axis) / sine;
    const double c = std::cos(s * half_angle);
    const double n = std::sin(s * half_angle);
    part.real << c, n * axis;
    part.dual << -s * half_slide * n, n * moment + s * half_slide * c * axis;
  }
  return normalized(p * part);
}

}  // namespace egocal
