// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// Motions of sensors a and b over one interval, each the pose of the later frame in the earlier one:
/// q_a q_T = q_T q_b (13) with T = T_a_b.
struct MotionPair {
  DualQuaternion a;
  DualQuaternion b;
  std::int64_t begin_us = 0;
  std::int64_t end_us = 0;
  double eta = 1;  ///< relative weight in (16), before the normalisation to sum 1
};
EGOCAL_SAME_LAYOUT(MotionPair)

/// The weights W of (15) that a drive can be re-weighted by after it was accumulated:
/// w1..w4 = rotation (the real rows), w5..w8 = translation (the dual rows) [1/m^2].
struct Balance {
  double rotation = 1;
  double translation = 1;
};
EGOCAL_SAME_LAYOUT(Balance)

/// Q_w of one pair for any eight row weights w1..w8 (15).
Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w = Vector8d::Ones());

/// 36 numbers, the whole memory of any number of motion pairs: sum of eta M_d'M_d over the dual rows M_d of
/// (14). Its lower right block is the rotation part D, so every Balance follows from it (docs/method.md, "The
/// cost is 36 numbers"). The sum is plain, in the order of the calls: the same calls give the same bits.
struct Statistics {
  Matrix8d dual_rows = Matrix8d::Zero();  ///< symmetric, both triangles filled
  double weight = 0;                      ///< sum of eta
  std::uint64_t count = 0;                ///< pairs

  /// a, b: unit dual quaternions of either sign (each counts with its real scalar >= 0); eta >= 0. Nothing of
  /// this is checked: NaN stays in the sum, and the solvers report it.
  void add(const DualQuaternion& a, const DualQuaternion& b, double eta = 1);
  void add(const MotionPair& pair) { add(pair.a, pair.b, pair.eta); }
  Statistics& operator+=(const Statistics& other);
};
EGOCAL_SAME_LAYOUT(Statistics)

/// Q of (16): normalised so that the eta sum to one. Zero where there are no pairs.
Matrix8d cost_matrix(const Statistics& statistics, const Balance& balance = {});

/// The sum of the blocks, in their order.
Statistics sum_blocks(const std::vector<Statistics>& blocks);

/// J(q) = q' Q q (16).
double cost(const Matrix8d& Q, const DualQuaternion& q);

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
