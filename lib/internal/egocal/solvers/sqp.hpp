// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/global.hpp"

namespace egocal {

struct SqpOptions {
  int max_iterations = 50;
};

/// A local minimum of (18) near the start by Newton steps on the KKT system with the exact Hessian (IV-A).
Solution solve_sqp(const Matrix8d& Q, const DualQuaternion& start, const SqpOptions& options = {});

}  // namespace egocal
