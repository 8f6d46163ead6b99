// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/solution.hpp"

namespace egocal {

/// The global minimum of (18) under (26), in closed form: with q2 = q3 = q5 = q8 = 0 it is the smaller
/// eigenvector of a 2 x 2 matrix. Q is that of motions seen from the plane frames (24); so is the answer T_p.
Solution solve_planar(const Matrix8d& Q_planar);

}  // namespace egocal
