// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

/// A 2-D path projected on a 3-D surface (V-A), seen by sensors that are rigidly mounted on what follows it.
enum class Terrain {
  flat,    ///< exactly planar motion
  rough,   ///< a mixture of sinusoids: a drive with one dominant rotation axis
  free,    ///< motion in all six degrees of freedom (a hand-held rig, a flying robot)
};

struct SimulationOptions {
  Terrain terrain = Terrain::rough;
  int poses = 1001;
  double rate = 10;             ///< poses a second [Hz]
  double speed = 8;             ///< along the path [m/s]
  double roughness = 0.3;       ///< amplitude of the surface [m]
  std::vector<Pose> T_vehicle_sensor = {Pose{}, Pose{}};
  double relative_noise = 0;    ///< of each motion, as a part of the mean rotation and translation of a motion (V-A)
  double noise_rotation = 0;    ///< absolute, added to the above [rad], per axis and motion
  double noise_translation = 0; ///< [m]
  bool random_walk = false;     ///< the noise of consecutive motions is correlated
  std::uint64_t seed = 1;
};

/// One trajectory a sensor, each in its own start frame, with the motions' noise accumulated. The same options give
/// the same bits on every machine with IEEE doubles (own random numbers, no library ones).
std::vector<Trajectory> simulate(const SimulationOptions& options);

}  // namespace egocal
