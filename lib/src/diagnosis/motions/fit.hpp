// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

/// Residuals of the motions at one extrinsic, in units.
Fit fit_at(const Motions& motions, const Pose& T_a_b, double motion_seconds,
           const MotionSampleOptions& options = {});

}  // namespace egocal::detail
