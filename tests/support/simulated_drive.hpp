// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::testing {

/// Two streams and the pose of b in a.
struct Streams {
  DualQuaternion T;
  Trajectory a, b;
  PairingOptions options;
};

/// A lidar on the roof and a camera behind the windscreen, of which the tests know at most this.
inline const Pose T_vehicle_a{rotation_exp({0.02, -0.01, 0.3}), {1, 0.2, 1.8}};
inline const Pose T_vehicle_b{rotation_exp({-1.2, 0.1, -1.3}), {1.5, -0.4, 1.5}};

/// The same path and surface for the same seed, whatever the noise.
inline Streams simulated_drive(SimulationOptions options) {
  options.T_vehicle_sensor = {T_vehicle_a, T_vehicle_b};
  auto trajectories = simulate(options);
  return {to_dual_quaternion(inverse(T_vehicle_a) * T_vehicle_b),
          std::move(trajectories[0]),
          std::move(trajectories[1]),
          {}};
}

/// A simulated drive with noise of this part of every motion; a minute.
inline Streams noisy_drive(Terrain terrain, double noise, int poses = 601) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = poses;
  options.relative_noise = noise;
  return simulated_drive(options);
}

}  // namespace egocal::testing
