// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// The pairs in whose time the vehicle moves: in both streams the turn or the way is at least this part of
/// the root mean square of its turns or ways. While a vehicle stands nothing shows the extrinsic, and the
/// errors of its odometry are others than on the move. All of them are the pairs themselves; some are copied
/// to `kept`, which the result then refers to.
std::span<const MotionPair> moving_pairs(std::span<const MotionPair> pairs, double least_motion,
                                         std::vector<MotionPair>& kept);

}  // namespace egocal::detail
