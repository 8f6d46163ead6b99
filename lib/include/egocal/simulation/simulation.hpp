// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// A 2-D path projected on a 3-D surface (V-A), seen by sensors that are rigidly mounted on what follows it.
enum class Terrain {
  flat,   ///< exactly planar motion
  rough,  ///< a mixture of sinusoids: a drive with one dominant rotation axis
  free,   ///< motion in all six degrees of freedom (a hand-held rig, a flying robot)
};

struct SimulationOptions {
  Terrain terrain = Terrain::rough;
  int poses = 1001;
  double rate = 10;         ///< poses a second [Hz]
  double speed = 8;         ///< along the path [m/s]
  double roughness = 0.05;  ///< amplitude of the surface [m]
  std::vector<Pose> T_vehicle_sensor = {Pose{}, Pose{}};
  double relative_noise =
      0;  ///< of each motion, per axis, as a part of the mean rotation and translation (V-A)
  double noise_rotation = 0;     ///< added to it [rad]
  double noise_translation = 0;  ///< [m]
  bool random_walk = false;  ///< the noise of consecutive motions is correlated (0.9 from one to the next)
  std::uint64_t seed = 1;    ///< of path, surface and noise
};

/// One trajectory a sensor, each in its own start frame, with the motions' noise accumulated. The same
/// options give the same bits (own random numbers). Throws Error on values out of range.
std::vector<Trajectory> simulate(const SimulationOptions& options);

}  // namespace egocal
