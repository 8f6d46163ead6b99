// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/online/answer.hpp"

namespace egocal {

/// What the motions tell of each direction around an answer: observability (is the curvature of the cost more than the
/// noise of the rotations alone would make?) and standard deviations by the block jack-knife.
Knowledge knowledge(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b, const Multipliers& lambda);

}  // namespace egocal
