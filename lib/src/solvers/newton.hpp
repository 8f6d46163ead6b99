// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/global.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// Newton steps on the KKT system of (18) from the start to the next minimum. Q must be finite, with lengths
/// in a unit near length_scale(); the lengths of the answer are in that unit too.
Solution newton_on_kkt(const Matrix8d& Q, const DualQuaternion& start, int max_iterations = 50);

}  // namespace egocal::detail
