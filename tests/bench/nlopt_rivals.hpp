// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::bench {

// NLopt as a careful user calls it, without what solve_slsqp adds before and after.

/// (18) by SLSQP.
DualQuaternion nlopt_slsqp(const Matrix8d& Q, const DualQuaternion& start);
/// (18) by the augmented Lagrangian with the preconditioned truncated Newton method inside.
DualQuaternion nlopt_augmented_lagrangian(const Matrix8d& Q, const DualQuaternion& start);
/// The planar problem in q1, q4, q6, q7 by SLSQP.
DualQuaternion nlopt_planar(const Matrix8d& Q_planar, const DualQuaternion& start);

}  // namespace egocal::bench
