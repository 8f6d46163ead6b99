// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions of streams with unknown scale. At a wrong scale no motions are congruent, so none is rejected.
#pragma once

#include <vector>

#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::detail {

/// Options that pair motions of this stride, unweighted, and reject none.
PairingOptions unjudged(PairingOptions pairing, int stride);

/// Motions that last about this long [s] by the mean period of the stream with fewer poses, and at most 64
/// steps; of a drive that is shorter, half or a quarter as long and so on. The time offset of `pairing` is
/// used, not estimated.
std::vector<MotionPair> unjudged_motions(const Trajectory& a, const Trajectory& b, PairingOptions pairing,
                                         double length);

}  // namespace egocal::detail
