// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "egocal/random.hpp"

namespace egocal::testing {

using egocal::Random;

/// Rotation vector [rad] and translation [m] to a displacement.
inline DualQuaternion displacement(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  return to_dual_quaternion({rotation_exp(rotation), translation});
}

enum class Motion {
  free,           ///< axes and slides in all directions
  dominant_axis,  ///< a vehicle: yaw, with a twentieth of it as roll and pitch
  planar,         ///< yaw, x and y only
  single_axis,    ///< turns about one axis, slides anywhere
  translation,    ///< never turns
};

struct RandomDrive {
  Motion motion = Motion::free;
  std::uint64_t pairs = 100;
  double rotation = 0.1;     ///< of one motion, standard deviation [rad]
  double translation = 0.8;  ///< [m]
  double noise = 0;          ///< relative to the two above, on each sensor
  bool flip_signs = false;   ///< q and -q are the same motion
};

/// Motions of sensors a and b that are mounted by T_a_b.
inline std::vector<MotionPair> random_pairs(const DualQuaternion& T_a_b, const RandomDrive& drive,
                                            Random& random) {
  std::vector<MotionPair> pairs;
  pairs.reserve(drive.pairs);
  const Eigen::Vector3d axis = random.direction();
  const bool planar = drive.motion == Motion::planar;
  for (std::uint64_t i = 0; i < drive.pairs; ++i) {
    Eigen::Vector3d rotation = random.normal3(drive.rotation),
                    translation = random.normal3(drive.translation);
    switch (drive.motion) {
      case Motion::free:
        break;
      case Motion::dominant_axis:
        rotation.head<2>() *= 0.05;
        translation[2] *= 0.05;
        break;
      case Motion::planar:
        rotation.head<2>().setZero();
        translation[2] = 0;
        break;
      case Motion::single_axis:
        rotation = rotation[2] * axis;
        break;
      case Motion::translation:
        rotation.setZero();
        break;
    }
    const DualQuaternion b = displacement(rotation, translation);
    const auto noisy = [&](const DualQuaternion& q) {
      Eigen::Vector3d turn = random.normal3(drive.noise * drive.rotation);
      Eigen::Vector3d shift = random.normal3(drive.noise * drive.translation);
      if (planar) {
        turn.head<2>().setZero();
        shift[2] = 0;
      }
      return q * displacement(turn, shift);
    };
    MotionPair pair{noisy(T_a_b * b * conjugate(T_a_b)), noisy(b)};
    if (drive.flip_signs && random.uniform() < 0.5) pair.a = -pair.a;
    if (drive.flip_signs && random.uniform() < 0.5) pair.b = -pair.b;
    pairs.push_back(pair);
  }
  return pairs;
}

inline Matrix8d cost_of(const std::vector<MotionPair>& pairs, const Balance& balance = {}) {
  Statistics statistics;
  for (const MotionPair& pair : pairs) statistics.add(pair);
  return cost_matrix(statistics, balance);
}

/// Rotation [rad] and translation [m] of the given sizes, each in any direction. Draws in one order, whatever
/// the compiler's order of arguments is.
inline DualQuaternion random_displacement(Random& random, double rotation, double translation) {
  const Eigen::Vector3d shift = random.direction(), axis = random.direction();
  return displacement(rotation * axis, translation * shift);
}

/// The same with normally distributed components of these standard deviations [rad, m].
inline DualQuaternion normal_displacement(Random& random, double rotation = 1, double translation = 1) {
  const Eigen::Vector3d shift = random.normal3(translation), turn = random.normal3(rotation);
  return displacement(turn, shift);
}

/// Any rotation at all, translation of about the given size [m].
inline DualQuaternion random_extrinsic(Random& random, double size = 2) {
  const Eigen::Vector3d shift = random.normal3(size), axis = random.direction();
  const double angle = random.uniform(0, std::numbers::pi);
  return displacement(angle * axis, shift);
}

/// x, y and yaw only.
inline DualQuaternion random_planar_extrinsic(Random& random, double size = 2) {
  const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double x = random.normal() * size, y = random.normal() * size;
  return displacement({0, 0, yaw}, {x, y, 0});
}

}  // namespace egocal::testing
