// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

namespace egocal {

Eigen::Matrix<double, 2, 1, Eigen::DontAlign> constraints(const DualQuaternion& q) {
  return {1 - q.real.squaredNorm(), 2 * q.real.dot(q.dual)};
}

Matrix8d lagrangian_matrix(const Matrix8d& Q, const Multipliers& lambda) {
  Matrix8d Z = Q;
  for (int i = 0; i < 4; ++i) {
    Z(i, i) -= lambda.norm;
    Z(i, i + 4) += lambda.orthogonal;
    Z(i + 4, i) += lambda.orthogonal;
  }
  return Z;
}

Multipliers least_squares_multipliers(const Matrix8d& Q, const DualQuaternion& q) {
  return least_squares_multipliers(q, Q * q.vec());
}

Multipliers least_squares_multipliers(const DualQuaternion& q, const Vector8d& g) {
  // Z(lambda) q = Q q + lambda_1 (-r, 0) + lambda_2 (d, r); the columns' products are |r|^2 and r.d
  const double rr = q.real.squaredNorm();
  const double rd = q.real.dot(q.dual);
  const double orthogonal_norm = rr + q.dual.squaredNorm();
  const double b1 = q.real.dot(g.head<4>());                               // - column_1 . g
  const double b2 = -(q.dual.dot(g.head<4>()) + q.real.dot(g.tail<4>()));  // - column_2 . g
  const double determinant = rr * orthogonal_norm - rd * rd;
  return {(orthogonal_norm * b1 + rd * b2) / determinant, (rr * b2 + rd * b1) / determinant};
}

double lagrangian(const Matrix8d& Q, const DualQuaternion& q, const Multipliers& lambda) {
  const Vector8d v = q.vec();
  return v.dot(lagrangian_matrix(Q, lambda) * v) + lambda.norm;
}

Eigen::Vector3d planar_constraints(const DualQuaternion& q) {
  return {q.real[1], q.real[2], q.real[0] * q.dual[3] - q.real[3] * q.dual[0]};
}

}  // namespace egocal
