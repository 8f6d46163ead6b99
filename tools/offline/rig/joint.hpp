// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "offline/rig/settings.hpp"

namespace egocal::tools {

/// The motions that several sensors of a rig have in common.
struct CommonMotions {
  std::vector<RigPair> pairs;         ///< of all sensors; in the order of the report's pairs
  std::vector<RigPair> single_steps;  ///< the shortest ones; empty where `pairs` are these
  double begin = 0;                   ///< of the first one, since the first pose of the first sensor [s]
};

/// Loops, noise and the joint minimum from the motions between instants that sensors share: all of them, or,
/// where these are few, those of each loop. Sets them in the report, whose pairs are calibrated already and
/// keep their answers. trajectories: on one clock. No motions where some two pairs share none.
CommonMotions solve_jointly(const std::vector<Trajectory>& trajectories, const RigSettings& settings,
                            RigReport& report);

/// Which set of extrinsics is printed as a tree and exported: RigReport::joint and why_not_joint. Not the
/// joint one where some pair should not be used: that pair has a part in each of its edges.
void choose_tree(RigReport& report);

}  // namespace egocal::tools
