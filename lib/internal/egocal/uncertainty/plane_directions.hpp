// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// In planar mode: whether the motions give this direction of sensor a (x y z roll pitch yaw), by its part in
/// the plane. The rest comes from the ground planes: what lies mostly along the normal (height), and turns
/// about what lies mostly in the plane (roll and pitch). A sensor may be mounted in any way; of a frame that
/// is tilted by 45 degrees, two axes count.
inline bool in_plane(const GroundPlane& plane_a, std::size_t direction) {
  const double along = std::abs(plane_a.normal[static_cast<int>(direction % 3)]);
  // mathematics: the larger part of a direction; and of three cosines, the largest is above 0.57
  constexpr double larger_part = 0.70711, of_yaw = 0.5;
  return direction < 3 ? along < larger_part : along > of_yaw;
}

}  // namespace egocal
