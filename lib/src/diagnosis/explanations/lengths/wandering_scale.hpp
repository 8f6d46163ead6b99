// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A scale of one stream that wanders by less than odometries do.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/scale/scale_course.hpp"

namespace egocal::detail {

/// A scale of b for each part of the drive that suits one extrinsic best. The lengths of an ordinary odometry
/// are off by some tenths of a percent for minutes, which on a car looks like a sensor that was moved along
/// its way. Empty where the scales differ by more. origin_us: of the motions' times.
std::optional<ScaleCourse> wandering_scale(const Motions& motions, std::int64_t origin_us,
                                           const std::vector<Finding>& moves,
                                           const DiagnosisOptions& options);

}  // namespace egocal::detail
