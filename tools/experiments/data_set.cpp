// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/data_set.hpp"
#include "egocal/problem/blocks.hpp"

#include <algorithm>

namespace egocal::tools {

std::vector<MotionPair> motions(const Trajectory& a, const Trajectory& b) {
  std::vector<MotionPair> pairs;
  const std::size_t poses = std::min(a.size(), b.size());
  for (std::size_t i = 1; i < poses; ++i) {
    pairs.push_back({conjugate(a[i - 1].pose) * a[i].pose, conjugate(b[i - 1].pose) * b[i].pose,
                     a[i - 1].time_us, a[i].time_us});
  }
  return pairs;
}

std::vector<MotionPair> planar_motions(const std::vector<MotionPair>& pairs, const GroundPlane& plane_a,
                                       const GroundPlane& plane_b) {
  const DualQuaternion G_a = plane_frame(plane_a), G_b = plane_frame(plane_b);
  std::vector<MotionPair> seen = pairs;
  for (MotionPair& pair : seen) {
    pair.a = planar_motion(pair.a, G_a);
    pair.b = planar_motion(pair.b, G_b);
  }
  return seen;
}

Problem problem_of(const DataSet& data, Mode mode, std::size_t count) {
  Problem problem;
  problem.mode = mode;
  problem.balance = data.balance;
  std::vector<MotionPair> pairs(data.pairs.begin(), data.pairs.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                             count, data.pairs.size())));
  if (mode == Mode::planar && data.plane_a && data.plane_b) {
    problem.plane_a = *data.plane_a;
    problem.plane_b = *data.plane_b;
    pairs = planar_motions(pairs, *data.plane_a, *data.plane_b);
  }
  BlockStatistics blocks;
  for (const MotionPair& pair : pairs) blocks.add(pair);
  problem.blocks = blocks.inliers();
  return problem;
}

}  // namespace egocal::tools
