// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A scale of one stream that wanders by less than odometries do.
#pragma once

#include <vector>

#include "diagnosis/robust_fit.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

/// Whether one extrinsic, with a scale of b for each part of the drive that differs little from the others,
/// explains the motions as well as moves of the mount do. The lengths of an ordinary odometry are off by some
/// tenths of a percent for minutes, which a car's sensor that slides along its way would show as well.
bool explained_by_wandering_scale(const Motions& motions, const Explained& moved,
                                  const std::vector<Finding>& moves, const DiagnosisOptions& options);

}  // namespace egocal::detail
