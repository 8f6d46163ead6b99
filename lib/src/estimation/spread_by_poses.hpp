// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "egocal/problem/problem.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// Directions (x y z roll pitch yaw of sensor a's frame) that the motions show.
using SeenDirections = std::array<bool, 6>;

SeenDirections seen_directions(const Problem& problem);

/// Scatter of the answers when blocks of instants are omitted, each with all motions that have an end in it.
/// Over the directions that the motions show.
struct SpreadByPoses {
  DualQuaternion T_a_b;                    ///< minimiser of (18) over all
  double score = 0;                        ///< sum of the logarithms of rotation's and translation's spread
  double rotation = 0;                     ///< [rad]
  double translation = 0;                  ///< [m]
  Matrix6d covariance = Matrix6d::Zero();  ///< of (dt, dtheta) in frame a [m, rad], zero where not seen
  std::vector<double> influence;           ///< of each block on the score

  /// Multiplies the spreads.
  void widen(double of_rotation, double of_translation);
};

/// problem: touching blocks, as WeightedBlocks makes them. The score is not finite if a block cannot be
/// omitted.
SpreadByPoses spread_by_poses(const Problem& problem, const SeenDirections& seen);

/// Standard error of the difference of two scores of the same blocks.
double standard_error(const SpreadByPoses& x, const SpreadByPoses& y);

}  // namespace egocal::detail
