// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/beside.hpp"
#include "egocal/calibrate.hpp"

namespace egocal {

/// The same bits as calibrate() without `beside`. What does not depend on each other is given to it: reading
/// signs of mistakes from the streams while their poses are paired.
Calibration calibrate(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                      const Beside& beside);

}  // namespace egocal
