// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// What the options of a simulated drive must obey, in a program and on a command line.
namespace limits::simulation {

inline constexpr Range poses{2, 1e7};                ///< of each sensor; of memory: 640 MB
inline constexpr Range rate{1e-3, 1e5};              ///< of the drive and of a sensor [Hz]
inline constexpr Range speed{-1e3, 1e3};             ///< [m/s]
inline constexpr Range speed_variation{0, 10};       ///< as a part of the speed
inline constexpr Range roughness{0, 1e3};            ///< [m]
inline constexpr Range noise{0, 1e3};                ///< of every kind [-, rad, m]
inline constexpr Range scale{1e-6, 1e6};             ///< of a sensor's lengths
inline constexpr Range scale_drift{-1, 1};           ///< [1/s]
inline constexpr Range clock_offset{-1e6, 1e6};      ///< [s]
inline constexpr Range clock_drift{-0.1, 0.1};       ///< [s/s]
inline constexpr Range dropped{0, 0.999};            ///< a share; of all poses none would be left
inline constexpr Range outliers{0, 1};               ///< a share
inline constexpr Range outlier_rotation{0, 1e3};     ///< [rad]
inline constexpr Range outlier_translation{0, 1e9};  ///< [m]
inline constexpr Range noise_factor{0, 1e6};         ///< of the drive's noise

}  // namespace limits::simulation

/// A 2-D path projected on a 3-D surface (V-A), seen by sensors that are rigidly mounted on what follows it.
enum class Terrain {
  flat,   ///< exactly planar motion
  rough,  ///< a mixture of sinusoids: a drive with one dominant rotation axis
  free,   ///< motion in all six degrees of freedom (a hand-held rig, a flying robot)
};

/// A sensor whose mount moves, which its odometry sees as its own motion.
struct MountChange {
  double begin = 0;  ///< [s] from the start of the drive
  double end = 0;    ///< [s]; not after begin: a bump; later: it creeps evenly from begin to end
  Pose change;       ///< pose of the sensor after the change in the sensor before it
};

/// An odometry that jumps in its own frame (relocalisation, a closed loop); the mount stays.
struct OdometryJump {
  double time = 0;  ///< [s] from the start of the drive
  Pose jump;        ///< of the newest pose, in the sensor's frame
};

/// What goes wrong with one sensor. The defaults are a sensor with none of it.
struct SensorFaults {
  double rate = 0;          ///< poses a second [Hz]; 0: that of the drive
  double phase = 0;         ///< time of the first pose [s]
  double scale = 1;         ///< its lengths must be multiplied by this to be metres (a monocular camera)
  double scale_drift = 0;   ///< relative change of the scale [1/s]
  double clock_offset = 0;  ///< added to its stamps [s]
  double clock_drift = 0;   ///< and this much more every second [s/s]
  double dropped = 0;       ///< share of its poses that are missing, at random
  double outliers = 0;      ///< share of its poses that are wrong, each by itself
  double outlier_rotation = 0.2;   ///< of a wrong pose, standard deviation per axis [rad]
  double outlier_translation = 1;  ///< [m]
  double noise_factor = 1;         ///< of the drive's noise
  std::vector<MountChange> mount_changes;
  std::vector<OdometryJump> jumps;
};

struct SimulationOptions {
  Terrain terrain = Terrain::rough;
  int poses = 1001;
  double rate = 10;  ///< poses a second [Hz]
  double speed = 8;  ///< along the path [m/s]
  /// On the ground: the speed varies by about this part of it within 10 to 60 s, and never falls below zero.
  double speed_variation = 0;
  double roughness = 0.05;  ///< amplitude of the surface [m]
  std::vector<Pose> T_vehicle_sensor = {Pose{}, Pose{}};
  double relative_noise =
      0;  ///< of each motion, per axis, as a part of the mean rotation and translation (V-A)
  double noise_of_motion = 0;    ///< and as a part of each motion itself
  double noise_rotation = 0;     ///< added to it [rad]
  double noise_translation = 0;  ///< [m]
  bool random_walk = false;  ///< the noise of consecutive motions is correlated (0.9 from one to the next)
  bool heavy_tails = false;  ///< the noise has Student's distribution with three degrees of freedom
  std::uint64_t seed = 1;    ///< of path, surface, noise and faults
  std::vector<SensorFaults> faults{};  ///< per sensor; empty or shorter: none
};

/// One trajectory a sensor, each in its own start frame, with the motions' noise accumulated. The same
/// options give the same bits (own random numbers), and a fault of one sensor changes no other sensor's
/// poses. Throws Error on values out of range, and where dropped poses leave none of a sensor. Thread-safe.
std::vector<Trajectory> simulate(const SimulationOptions& options);

/// Pose of sensor b in sensor a at a time of the drive [s], with the mount changes up to then. a, b: indices
/// of T_vehicle_sensor; throws Error for others. Thread-safe.
Pose true_extrinsic(const SimulationOptions& options, std::size_t a, std::size_t b, double time = 0);

}  // namespace egocal
