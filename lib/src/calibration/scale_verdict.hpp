// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/calibrate.hpp"
#include "egocal/scale/estimate_scale.hpp"

namespace egocal::detail {

DriveScaleOptions scale_options(const CalibrationOptions& options);

/// What the scale adds to an answer: where it is not known, the answer is not.
void put_scale(const std::optional<ScaleSolution>& estimate, double scale, const CalibrationOptions& options,
               Calibration& result);

}  // namespace egocal::detail
