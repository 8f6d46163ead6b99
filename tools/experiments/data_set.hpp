// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::tools {

/// What an experiment is run on.
struct DataSet {
  std::vector<MotionPair> pairs;  ///< as the sensors saw them, not yet seen from any plane
  std::optional<DualQuaternion> truth;
  std::optional<GroundPlane> plane_a, plane_b;  ///< both or none: whether the planar mode can be run
  Balance balance;
  std::vector<std::string> notes;  ///< what was assumed, repaired or lost while reading, with the file's name
};

/// Motions between consecutive poses of two trajectories that are synchronous index by index.
std::vector<MotionPair> motions(const Trajectory& a, const Trajectory& b);

/// The pairs as seen from the ground planes (24).
std::vector<MotionPair> planar_motions(const std::vector<MotionPair>& pairs, const GroundPlane& plane_a,
                                       const GroundPlane& plane_b);

/// A problem of the first `count` pairs in consecutive blocks.
Problem problem_of(const DataSet& data, Mode mode, std::size_t count);

}  // namespace egocal::tools
