// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

enum class SolverStatus {
  converged,
  iteration_limit,  ///< the best point found; the certificate says what it is worth
  degenerate,       ///< no motion, or numbers that cannot be solved; q is the start or the identity
  not_finite,       ///< the cost matrix holds NaN or infinity; q is the identity
};

/// What a solver of (18) returns. It is not a proof: see certificate/.
struct Solution {
  DualQuaternion q;  ///< unit, canonical sign
  double cost = 0;   ///< J(q)
  Multipliers lambda;
  SolverStatus status = SolverStatus::converged;
  int iterations = 0;
};
EGOCAL_SAME_LAYOUT(Solution)

/// The global minimum of (18) by maximising its dual (22) over the one multiplier that is left when lambda_1
/// and the dual part of q are eliminated: phi(m) = lambda_min(A - (B + m I) inv(D) (B + m I)'), concave in m.
/// No start value, no allocation. The relaxation is tight for every Q (docs/method.md). Q: symmetric positive
/// semidefinite 8 x 8 of cost_matrix(). Never throws: the status says what was wrong with Q. Deterministic.
/// Thread-safe.
Solution solve_dual(const Matrix8d& Q);

/// The global minimum of (18) under (26), in closed form: with q2 = q3 = q5 = q8 = 0 it is the smaller
/// eigenvector of a 2 x 2 matrix. Q is that of motions seen from the plane frames (24); so is the answer T_p.
/// Never throws: the status says what was wrong with Q. Deterministic. Thread-safe.
Solution solve_planar(const Matrix8d& Q_planar);

}  // namespace egocal
