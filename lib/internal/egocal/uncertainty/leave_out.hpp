// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// The change by omitting each block: the minimum without it less the minimum with all, (dt [m], dtheta
/// [rad]) in sensor a's frame, by one Newton step (planar mode: solved). Infinite where the rest has no
/// minimum. T_a_b: the minimiser of Q, Q: cost_matrix(problem).
std::vector<Eigen::Matrix<double, 6, 1>> leave_out_differences(const Problem& problem, const Matrix8d& Q,
                                                               const DualQuaternion& T_a_b);

}  // namespace egocal
