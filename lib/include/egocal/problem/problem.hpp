// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "egocal/problem/ground_plane.hpp"

namespace egocal {

enum class Mode {
  spatial,  ///< six degrees of freedom
  planar,   ///< x, y and yaw; the rest from the ground planes (III-E)
};

/// All that a solver needs to know of one sensor pair.
struct Problem {
  Mode mode = Mode::spatial;
  GroundPlane plane_a, plane_b;    ///< planar mode: the blocks hold motions seen from these planes (24)
  Balance balance;                 ///< of rotation and translation
  std::vector<Statistics> blocks;  ///< consecutive; their sum is the whole
  /// Where the answer is taken from in directions that the motions do not show.
  std::optional<DualQuaternion> prior;
};
EGOCAL_SAME_LAYOUT(Problem)

/// Q of (16), all blocks together.
Matrix8d cost_matrix(const Problem& problem);

}  // namespace egocal
