// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/global.hpp"

namespace egocal {

struct SlsqpOptions {
  int max_evaluations = 500;
  double max_seconds =
      1.0;  ///< a last resort: answers that end here depend on the machine and are marked iteration_limit
};

/// A local minimum of (18) near the start by NLopt's SLSQP, the paper's fast method (IV-A).
Solution solve_slsqp(const Matrix8d& Q, const DualQuaternion& start, const SlsqpOptions& options = {});
/// The same under (26), in the four variables q1, q4, q6, q7 that are left.
Solution solve_slsqp_planar(const Matrix8d& Q_planar, const DualQuaternion& start,
                            const SlsqpOptions& options = {});

}  // namespace egocal
