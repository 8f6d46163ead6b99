// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions that keep the axes of sensor a, and the problem that pairs of motions make.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "../support/random_motion.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::testing {

inline Problem problem_of(const std::vector<MotionPair>& pairs) {
  BlockStatistics blocks;
  for (const MotionPair& pair : pairs) blocks.add(pair);
  Problem problem;
  problem.blocks = blocks.inliers();
  return problem;
}

/// Motions of a that keep its own axes: z is the axis of turns.
inline std::vector<MotionPair> motions_of_a(const DualQuaternion& T, int n, double noise, std::uint64_t seed,
                                            const std::function<DualQuaternion(Random&)>& motion) {
  Random random(seed);
  std::vector<MotionPair> pairs;
  for (int i = 0; i < n; ++i) {
    const DualQuaternion a = motion(random);
    const auto noisy = [&](const DualQuaternion& q) {
      const Eigen::Vector3d turn = random.normal3(noise * 0.05), shift = random.normal3(noise);
      return q * displacement(turn, shift);
    };
    const DualQuaternion b = conjugate(T) * a * T;
    const DualQuaternion noisy_a = noisy(a);
    pairs.push_back({noisy_a, noisy(b)});
  }
  return pairs;
}

inline const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});

inline DualQuaternion planar_motion_of_a(Random& random) {
  const double yaw = 0.05 * random.normal(), x = 1 + 0.1 * random.normal(), y = 0.05 * random.normal();
  return displacement({0, 0, yaw}, {x, y, 0});
}

}  // namespace egocal::testing
