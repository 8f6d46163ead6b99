// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// The pairs in which the vehicle moves: in both streams the turn or the way is at least this part of the
/// root mean square. A vehicle at rest shows nothing of the extrinsic, and its odometry has other errors than
/// on the move. If all pairs qualify the result is `pairs`; otherwise it refers to `kept`, which gets the
/// copies.
std::span<const MotionPair> moving_pairs(std::span<const MotionPair> pairs, double least_motion,
                                         std::vector<MotionPair>& kept);

}  // namespace egocal::detail
