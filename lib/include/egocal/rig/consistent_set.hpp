// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// The motions of two sensors of a rig as a cost matrix. Sensors are numbered from 0.
struct RigEdge {
  std::size_t a = 0, b = 0;
  Matrix8d Q;  ///< cost_matrix() of T_a_b, 3-D, lengths in metres, any weight
};
EGOCAL_SAME_LAYOUT(RigEdge)

/// Poses of all sensors that fit all pairs best.
struct ConsistentSet {
  /// False where the pairs do not connect all sensors, or a cost matrix is not usable; nothing else is set.
  bool solved = false;
  std::vector<DualQuaternion> poses;  ///< of every sensor in sensor 0
  /// Sum over the pairs of J / J_min: each pair's own minimum counts 1, so that noisy pairs count less.
  double cost = 0;
  /// What the pairs would cost one by one, less a margin: `cost` lies above by what the loops do not close.
  double pairwise_bound = 0;
  /// No set of poses has a lower cost than this. Equal to pairwise_bound where nothing better is proven.
  double lower_bound = 0;
  double rounding = 0;  ///< of the cost: what double precision cannot tell apart
  /// Globally optimal: cost - lower_bound is at most twice the rounding (docs/rigs.md has the proof).
  bool certified = false;
};

/// The joint minimum over all pairs and its proof. A certificate needs a pair of sensor 0 with every other
/// sensor, and motions that show all directions. Deterministic, thread-safe, throws nothing.
ConsistentSet solve_consistent_set(std::size_t sensors, std::span<const RigEdge> edges);

}  // namespace egocal
