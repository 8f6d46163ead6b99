// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The global minimum in either mode, for what asks for many of them and proves none.
#pragma once

#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// The minimiser of (18); planar mode: T_p, that of (18) under (26).
DualQuaternion minimiser(const Matrix8d& Q, Mode mode);

/// T_a_b of a minimiser of the problem's cost; planar mode: (27).
DualQuaternion extrinsic_of(const Problem& problem, const DualQuaternion& q);

/// T_a_b that minimises (18) over the statistics; mode, planes and balance are the problem's.
DualQuaternion extrinsic_of(const Problem& problem, const Statistics& statistics);

}  // namespace egocal::detail
