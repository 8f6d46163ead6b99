// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// lambda of (19): that of |real| = 1 and that of real . dual = 0.
struct Multipliers {
  double norm = 0;        ///< lambda_1, the dual objective (22a)
  double orthogonal = 0;  ///< lambda_2
};
EGOCAL_SAME_LAYOUT(Multipliers)

/// g1, g2 of (17).
Eigen::Matrix<double, 2, 1, Eigen::DontAlign> constraints(const DualQuaternion& q);
/// Z(lambda) of (21): Q - lambda_1 [I 0; 0 0] + lambda_2 [0 I; I 0].
Matrix8d lagrangian_matrix(const Matrix8d& Q, const Multipliers& lambda);
/// lambda by least squares from Z(lambda) q = 0 (28).
Multipliers least_squares_multipliers(const Matrix8d& Q, const DualQuaternion& q);
/// The same from the product Qq.
Multipliers least_squares_multipliers(const DualQuaternion& q, const Vector8d& Qq);
/// L(q, lambda) of (19), (21).
double lagrangian(const Matrix8d& Q, const DualQuaternion& q, const Multipliers& lambda);

/// q2, q3 and q1 q8 - q4 q5 of (26), all zero for a planar displacement. (The paper's q2^2 + q3^2 = 0 is the
/// same set but has no gradient on it.)
Eigen::Vector3d planar_constraints(const DualQuaternion& q);

}  // namespace egocal
