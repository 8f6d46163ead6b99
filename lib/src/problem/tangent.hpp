// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal::detail {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix86d = Eigen::Matrix<double, 8, 6>;

/// A length that makes rotations and translations comparable [m]: translations are counted in it, so that
/// conditioning does not depend on the user's unit. A power of two: scaling by it is exact.
inline double length_scale(const Matrix8d& Q) {
  const double a = Q.topLeftCorner<4, 4>().trace();
  const double d = Q.bottomRightCorner<4, 4>().trace();
  // below 1e-28 the rotations are rounding: a radian in 1e14 m
  if (!(a > 0) || !(d > 1e-28 * a)) return 1;
  return std::exp2(std::round(0.5 * std::log2(a / d)));
}

/// Q, q and lambda (lambda_2 multiplies a length) with lengths counted in `length`.
inline Matrix8d in_units_of(double length, const Matrix8d& Q) {
  Matrix8d scaled = Q;
  scaled.topRightCorner<4, 4>() *= length;
  scaled.bottomLeftCorner<4, 4>() *= length;
  scaled.bottomRightCorner<4, 4>() *= length * length;
  return scaled;
}
inline DualQuaternion in_units_of(double length, const DualQuaternion& q) {
  return {q.real, q.dual / length};
}
inline Multipliers in_units_of(double length, const Multipliers& lambda) {
  return {lambda.norm, lambda.orthogonal * length};
}

/// Directions in which q can move on the constraints (17): q (1 + x_r + eps x_t) with x_r, x_t imaginary. The
/// columns span the tangent space; x_r is half a rotation vector, x_t half a translation, in sensor b's
/// frame.
inline Matrix86d tangent_basis(const DualQuaternion& q) {
  Matrix86d T;
  T.topLeftCorner<4, 3>() = left_matrix(q.real).rightCols<3>();
  T.bottomLeftCorner<4, 3>() = left_matrix(q.dual).rightCols<3>();
  T.topRightCorner<4, 3>().setZero();
  T.bottomRightCorner<4, 3>() = T.topLeftCorner<4, 3>();
  return T;
}

/// The unit dual quaternion reached from q along x.
inline DualQuaternion retract(const DualQuaternion& q, const Vector6d& x) {
  DualQuaternion p;
  p.real << 1, x.head<3>();
  p.dual << 0, x.tail<3>();
  return normalized(q * p);
}

}  // namespace egocal::detail
