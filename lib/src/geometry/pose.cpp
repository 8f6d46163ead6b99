// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/geometry/pose.hpp"

#include <cmath>

namespace egocal {

Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
  return {(T_a_b.rotation * T_b_c.rotation).normalized(),
          T_a_b.rotation * T_b_c.translation + T_a_b.translation};
}

Pose inverse(const Pose& T_a_b) {
  const Rotation rotation = T_a_b.rotation.conjugate();
  return {rotation, -(rotation * T_a_b.translation)};
}

Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b) {
  return T_a_b.rotation * p_b + T_a_b.translation;
}

Rotation rotation_exp(const Eigen::Vector3d& rotation_vector) {
  const double half = 0.5 * rotation_vector.norm();
  // sin(h)/h by its series where the quotient would be 0/0
  const double factor = half < 1e-4 ? 0.5 * (1 - half * half / 6) : 0.5 * std::sin(half) / half;
  const Eigen::Vector3d v = factor * rotation_vector;
  return Rotation(std::cos(half), v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d rotation_log(const Rotation& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const Eigen::Vector3d v = sign * rotation.vec();
  const double w = sign * rotation.w();
  const double sine = v.norm();
  if (sine < 1e-12) return 2 * v;
  return 2 * std::atan2(sine, w) / sine * v;
}

Eigen::Vector3d roll_pitch_yaw(const Rotation& rotation) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  // where the pitch is nearly a quarter turn the yaw is rounding; the roll is then the one that suits it
  const double yaw = std::atan2(R(1, 0), R(0, 0)), c = std::cos(yaw), s = std::sin(yaw);
  return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)), pitch, yaw};
}

}  // namespace egocal
