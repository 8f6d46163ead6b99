// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

/// Residuals of the motions at one extrinsic, in units.
Fit fit_at(const Motions& motions, const Pose& T_a_b, double motion_seconds,
           const MotionSampleOptions& options = {});

/// What the extrinsic leaves of the translations as a part of their lengths, the median over the way: where a
/// vehicle mostly stands, noise is all that most of the motions are.
double relative_by_way(const Motions& motions, const Pose& T_a_b);

}  // namespace egocal::detail
