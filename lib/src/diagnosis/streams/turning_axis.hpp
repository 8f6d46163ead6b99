// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The axis that a sensor mostly turns about, and how far it turns about others.
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct TurningAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in the sensor's frame, of unit length; either end
  double tilt = 0;  ///< root mean square of how far the motions move that axis [rad]
};

/// Turning axis of the motions of one sensor; there must be some.
TurningAxis turning_axis(const Motions& motions, Side side);

/// Root mean square of what both sensors differ by in turning about their axes [rad]; there must be motions.
double turning_difference(const Motions& motions, const Eigen::Vector3d& axis_a,
                          const Eigen::Vector3d& axis_b);

}  // namespace egocal::detail
