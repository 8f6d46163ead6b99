// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/solution.hpp"

namespace egocal {

/// The global minimum of (18) by maximising its dual (22) over the one multiplier that is left when lambda_1
/// and the dual part of q are eliminated: phi(m) = lambda_min(A - (B + m I) inv(D) (B + m I)'), concave in m.
/// No start value, no allocation. The relaxation is tight for every Q (docs/method.md). Q: symmetric positive
/// semidefinite 8 x 8 of cost_matrix().
Solution solve_dual(const Matrix8d& Q);

}  // namespace egocal
