// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives with moving mounts, and the moves found in them.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "egocal/moves/find_moves.hpp"
#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

inline constexpr double degrees = 180 / std::numbers::pi;

inline SimulationOptions moved_drive(Terrain terrain, std::uint64_t seed, double seconds = 120) {
  SimulationOptions options;
  options.terrain = terrain;
  options.seed = seed;
  options.poses = static_cast<int>(10 * seconds) + 1;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {T_vehicle_a, T_vehicle_b};
  options.faults.resize(2);
  return options;
}

/// Half a degree and 3 cm about an axis that depends on the seed.
inline MountChange bump(double time, std::uint64_t seed, double size = 1) {
  const double s = static_cast<double>(seed);
  const Eigen::Vector3d axis =
      Eigen::Vector3d(std::sin(s), std::cos(2 * s), std::sin(3 * s + 1)).normalized();
  return {time, time, {rotation_exp(size * 0.5 / degrees * axis), size * 0.03 * axis}};
}

/// Adds errors of 0.3 degrees and 2 cm to orientation and position, remembered for 6 s.
inline Trajectory with_wandering_errors(Trajectory poses, std::uint64_t seed) {
  Random random(seed);
  const double keep = std::exp(-0.1 / 6), fresh = std::sqrt(1 - keep * keep);
  Eigen::Vector3d turn = random.normal3(0.3 / degrees), shift = random.normal3(0.02);
  for (StampedPose& pose : poses) {
    turn = keep * turn + fresh * random.normal3(0.3 / degrees);
    shift = keep * shift + fresh * random.normal3(0.02);
    pose.pose = pose.pose * to_dual_quaternion(Pose{rotation_exp(turn), shift});
  }
  return poses;
}

inline MovesResult moves_of(const Trajectory& a, const Trajectory& b, PairingOptions pairing = {},
                            const MovesOptions& options = {}) {
  const Choice choice = pair_motions(pairing, a, b).drive.choice();
  pairing.balance = choice.balance;
  Problem problem;
  problem.mode = pairing.mode;
  problem.plane_a = pairing.plane_a;
  problem.plane_b = pairing.plane_b;
  problem.balance = choice.balance;
  std::vector<std::vector<MotionPair>> strides;
  for (const int stride : {1, choice.stride}) {
    pairing.stride = stride;
    strides.push_back(pair_motions(pairing, a, b).pairs);
  }
  return find_moves_of_strides(strides, problem, options);
}

inline MovesResult moves_of(const SimulationOptions& options) {
  const auto trajectories = simulate(options);
  return moves_of(trajectories[0], trajectories[1]);
}

}  // namespace egocal::testing
