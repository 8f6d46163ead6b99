// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/calibrate.hpp"

namespace egocal::detail {

/// What both streams being inverted by options means for the answer: streams that were right agree as well
/// then, with one that is wrong by metres. Adds inverted_both where that is likely, and a verdict of
/// `doubtful` at least. a, b: as inverted, and as they were calibrated.
void doubt_inversion_of_both(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                             Calibration& calibration);

}  // namespace egocal::detail
