// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/robust/prove_outliers.hpp"

namespace egocal {

/// Whether the motions that a pairing rejects are the best choice of outliers. Motions that
/// end at the newest instants, whose verdicts may change, are not looked at. Empty where nothing was judged,
/// and in planar mode. Milliseconds: for the end of a drive, not for every pose.
std::optional<OutlierProof> prove_outliers(const MotionPairing& pairing);

}  // namespace egocal
