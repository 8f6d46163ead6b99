// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/uncertainty/observability.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal::detail {

/// Coordinates whose first `shown` directions are seen. basis: from them to (dt in units of length, dtheta).
struct ShownDirections {
  TangentSpace space;
  Matrix6d basis;
  int shown;
};

/// Variance of the coordinates in the frame of sensor a, by the jack-knife over the blocks of a problem.
/// Errors that near blocks may share increase it as their correlations say, beyond the correlation of blocks
/// that have a motion in common. pairs: in all blocks. Lengths in units of the space.
Vector6d variance_by_blocks(const Problem& problem, double pairs, const ShownDirections& directions,
                            ErrorCorrelation errors, const ObservabilityOptions& options);

}  // namespace egocal::detail
