// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Simulated sets of still poses: a camera on the hand of an arm looks at a target.
#pragma once

#include <numbers>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

struct ArmSamples {
  std::size_t samples = 10;
  double cone = 45;             ///< half angle of the directions from which the camera looks [deg]
  double rotation_noise = 0.1;  ///< of the detected target, each axis [deg]
  double position_noise = 1;    ///< [mm]
  double robot_noise = 0.2;     ///< of the robot, as a part of the two above
  std::size_t wrong = 0;        ///< samples off by 20 to 90 deg and up to 10 cm a direction
};

struct SimulatedSamples {
  DualQuaternion X, Y;  ///< camera in the hand, target in the base
  std::vector<PoseSample> samples;
  std::vector<bool> wrong;
};

inline Pose noisy(const Pose& T, double rotation, double position, Random& random) {
  const Eigen::Vector3d turn = random.normal3(rotation), shift = random.normal3(position);
  return {(rotation_exp(turn) * T.rotation).normalized(), T.translation + shift};
}

/// A set with the camera 0.4 to 0.8 m from the target, looking at it, turned about its axis by up to a third
/// of a turn.
inline SimulatedSamples simulate_arm(const ArmSamples& what, Random& random) {
  constexpr double degree = std::numbers::pi / 180, mm = 1e-3;
  const auto anywhere = [&](double size) {
    const double x = random.uniform(-size, size), y = random.uniform(-size, size),
                 z = random.uniform(-size, size);
    return Eigen::Vector3d(x, y, z);
  };
  const auto any_pose = [&](double size) {
    const Eigen::Vector3d axis = random.direction();
    const double angle = random.uniform(0, std::numbers::pi);
    return Pose{rotation_exp(angle * axis), anywhere(size)};
  };
  const Pose X = any_pose(0.1), Y = any_pose(0.8);
  SimulatedSamples result{to_dual_quaternion(X), to_dual_quaternion(Y), {}, {}};
  for (std::size_t i = 0; i < what.samples; ++i) {
    const double cosine = random.uniform(std::cos(what.cone * degree), 1);
    const double sine = std::sqrt(1 - cosine * cosine), around = random.uniform(0, 2 * std::numbers::pi);
    const double distance = random.uniform(0.4, 0.8), roll = random.uniform(-1, 1) * 60 * degree;
    // the camera's z axis points at the target
    const Eigen::Vector3d direction(sine * std::cos(around), sine * std::sin(around), cosine);
    const Rotation look(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -direction));
    const Eigen::Vector3d aside = random.normal3(3 * degree);
    const Pose eye{(look * rotation_exp({0, 0, roll}) * rotation_exp(aside)).normalized(),
                   distance * direction};
    const Pose hand = Y * eye * inverse(X);
    Pose target = noisy(inverse(eye), what.rotation_noise * degree, what.position_noise * mm, random);
    const Pose measured = noisy(hand, what.robot_noise * what.rotation_noise * degree,
                                what.robot_noise * what.position_noise * mm, random);
    const bool wrong = i < what.wrong;
    if (wrong) {
      const double angle = random.uniform(20, 90) * degree;
      const Eigen::Vector3d turn = angle * random.direction();
      target = {(rotation_exp(turn) * target.rotation).normalized(), target.translation + anywhere(0.1)};
    }
    result.wrong.push_back(wrong);
    result.samples.push_back({to_dual_quaternion(measured), to_dual_quaternion(inverse(target))});
  }
  return result;
}

}  // namespace egocal::testing
