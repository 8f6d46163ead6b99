// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "egocal/moves/find_moves.hpp"

namespace egocal::detail {

/// Where a change is among motion pairs.
struct ChangePlace {
  std::size_t at = 0;                    ///< first pair after it
  std::size_t earliest = 0, latest = 0;  ///< the least and the most that fit about as well
};

/// Locates a change from `before` to `after` (minimisers, planar mode: T_p) motion by motion, by the cost of
/// both. Indices count from the first of `pairs`, at least two. correlation: variance of a mean of neighbours
/// over that of independent motions; overlap: motions that share a pose.
ChangePlace locate_change(std::span<const MotionPair> pairs, const Problem& problem,
                          const DualQuaternion& before, const DualQuaternion& after, double correlation,
                          std::size_t overlap, const MovesOptions& options);

}  // namespace egocal::detail
