// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// Whether the ground planes suit the motions: the normals point up (the ground is below the sensor) and
/// along the axis that each sensor turns about, both in the same sense.
std::vector<Finding> check_planes(const Motions& motions, const GroundPlane& a, const GroundPlane& b,
                                  const PlaneCheckOptions& options);

}  // namespace egocal::detail
