// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/uncertainty/observability.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal::detail {

/// Coordinates in which the first `shown` directions are seen; basis: from them to (dt in units of length,
/// dtheta).
struct ShownDirections {
  TangentSpace space;
  Matrix6d basis;
  int shown;
};

/// Of the coordinates in sensor a's frame, by the jack-knife over the blocks of a problem: per direction the
/// larger of the variances with single and with double blocks, times what longer parts say. pairs: in all
/// blocks. Lengths in units of the space.
Vector6d spatial_variance(const Problem& problem, double pairs, const ShownDirections& directions,
                          ErrorCorrelation errors, const ObservabilityOptions& options);

/// The same in the plane, with single and double blocks, each minimum solved for [m^2, rad^2]. all: the sum
/// of the blocks.
Vector6d planar_variance(const Problem& problem, const Statistics& all, const DualQuaternion& T_a_b,
                         ErrorCorrelation errors, const ObservabilityOptions& options);

}  // namespace egocal::detail
