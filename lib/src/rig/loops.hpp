// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/rig/rig.hpp"

namespace egocal::detail {

/// Statistics of one pair in parts of the drive that are the same for all pairs.
struct TimedPair {
  std::vector<Statistics> blocks;
  Statistics all;
};

/// How far noisy rotations pull a translation towards zero, r'Dr inv(D) t (docs/method.md): pairs whose
/// sensors have unlike noise are pulled unlike far, and a loop does not close by that. Sensor a's frame [m].
Eigen::Vector3d attenuation(const Statistics& statistics, const DualQuaternion& T_a_b);

/// All loops of three sensors that have all three pairs. timed: one of every pair, with options.blocks
/// blocks.
std::vector<Loop> loops_of(std::size_t sensors, std::span<const RigPair> pairs,
                           std::span<const TimedPair> timed, const RigOptions& options);

}  // namespace egocal::detail
