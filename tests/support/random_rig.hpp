// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/rig/rig.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

/// Motions of a rig: every sensor sees the same drive with noise of its own.
struct RandomRig {
  std::vector<DualQuaternion> mounts;  ///< in sensor 0
  std::vector<RigPair> pairs;          ///< all of them
};

struct RandomRigOptions {
  std::size_t sensors = 3;
  std::size_t motions = 400;
  double noise = 0.01;  ///< of each sensor, relative to the mean motion
  bool road = false;    ///< roll and pitch a fifth of yaw, hardly any heave
  double unlike = 1;    ///< sensors' noise differs by up to this factor
  Balance balance{1, 0.02};
};

inline RandomRig random_rig(const RandomRigOptions& options, Random& random) {
  constexpr double turn_size = 0.1, shift_size = 0.8;  // [rad], [m]
  RandomRig rig;
  std::vector<std::vector<DualQuaternion>> seen(options.sensors);
  std::vector<double> noise;
  for (std::size_t k = 0; k < options.sensors; ++k) {
    rig.mounts.push_back(k == 0 ? DualQuaternion{} : random_extrinsic(random, 0.7));
    noise.push_back(options.noise * (options.unlike > 1 ? random.log_uniform(1, options.unlike) : 1));
  }
  for (std::size_t i = 0; i < options.motions; ++i) {
    Eigen::Vector3d turn = random.normal3(turn_size), shift = random.normal3(shift_size);
    if (options.road) {
      turn.head<2>() *= 0.2;
      shift[2] *= 0.1;
    }
    const DualQuaternion drive = displacement(turn, shift);
    for (std::size_t k = 0; k < options.sensors; ++k) {
      const Eigen::Vector3d turned = random.normal3(noise[k] * turn_size);
      const Eigen::Vector3d shifted = random.normal3(noise[k] * shift_size);
      seen[k].push_back(conjugate(rig.mounts[k]) * drive * rig.mounts[k] * displacement(turned, shifted));
    }
  }
  for (std::size_t a = 0; a < options.sensors; ++a)
    for (std::size_t b = a + 1; b < options.sensors; ++b) {
      RigPair pair{a, b, {}, {}, {}};
      pair.problem.balance = options.balance;
      for (std::size_t i = 0; i < options.motions; ++i) {
        const auto time = static_cast<std::int64_t>(i) * 100'000;
        pair.pairs.push_back({seen[a][i], seen[b][i], time, time + 100'000, 1});
      }
      rig.pairs.push_back(std::move(pair));
    }
  return rig;
}

/// The cost matrices of all pairs.
inline std::vector<RigEdge> edges_of(const RandomRig& rig) {
  std::vector<RigEdge> edges;
  for (const RigPair& pair : rig.pairs)
    edges.push_back({pair.a, pair.b, cost_of(pair.pairs, pair.problem.balance)});
  return edges;
}

}  // namespace egocal::testing
