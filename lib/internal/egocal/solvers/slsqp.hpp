// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/global.hpp"

namespace egocal {

struct SlsqpOptions {
  int max_evaluations = 500;
  double max_seconds =
      1.0;  ///< a last resort: answers that end here depend on the machine and are marked iteration_limit
  /// NLopt keeps the best *feasible* iterate, and an exact unit dual quaternion is more feasible than any
  /// later one: a tight tolerance returns the unchanged start as success. With 1e-12 that happened in 57 % of
  /// 3,000 noisy warm starts, with 1e-8 never (tests/lib/test_slsqp.cpp). The answer is projected back.
  double constraint_tolerance = 1e-8;
  /// Costs relative to trace(Q) below this are rounding of Q; without it a cost of zero is never reached.
  double absolute_tolerance = 1e-20;
  double relative_tolerance = 1e-14;  ///< of the cost, between iterations: near its rounding
  /// NLopt watches the cost, which stops changing at about the root of its rounding in the argument, 1e-8.
  /// Newton steps find the rest; they are no search of their own, so they may not lead further than this
  /// [units of length, radians].
  double finish = 1e-2;
};

/// A local minimum of (18) near the start by NLopt's SLSQP, the paper's fast method (IV-A).
Solution solve_slsqp(const Matrix8d& Q, const DualQuaternion& start, const SlsqpOptions& options = {});
/// The same under (26), in the four variables q1, q4, q6, q7 that are left.
Solution solve_slsqp_planar(const Matrix8d& Q_planar, const DualQuaternion& start,
                            const SlsqpOptions& options = {});

}  // namespace egocal
