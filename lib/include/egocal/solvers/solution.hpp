// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/problem/constraints.hpp"

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

}  // namespace egocal
