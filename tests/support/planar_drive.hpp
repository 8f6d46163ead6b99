// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry beside a SLAM of flat scans: neither stream measures roll, pitch and height.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

/// Poses of two sensors of a vehicle on flat ground. Each pose of b, which is mounted with a tilt, is written
/// as x, y and yaw alone; noise_tilt: of roll and pitch [rad].
struct PlanarDrive {
  Trajectory a, b;
  double yaw = 0.5, tilt = 5 * std::numbers::pi / 180;  ///< [rad]
};

inline PlanarDrive planar_drive(std::uint64_t seed, double noise, double noise_tilt) {
  PlanarDrive result;
  Random random(seed);
  const Pose mounting{
      Rotation(rotation_exp({0, 0, result.yaw})) * Rotation(rotation_exp({result.tilt, 0, 0})),
      {0.8, 0.3, 0.2}};
  double x = 0, y = 0, heading = 0;
  for (int i = 0; i < 600; ++i) {
    heading += 0.06 * std::sin(0.021 * i) + 0.03 * std::sin(0.13 * i);
    x += 0.1 * std::cos(heading);
    y += 0.1 * std::sin(heading);
    const Pose body{Rotation(rotation_exp({0, 0, heading})), {x, y, 0}};
    const Pose tilted = body * mounting;
    const auto level = [&](const Pose& pose) {
      const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
      const double turned = std::atan2(ahead.y(), ahead.x()) + noise * random.normal();
      return Pose{Rotation(rotation_exp({0, 0, turned})) *
                      Rotation(rotation_exp({noise_tilt * random.normal(), noise_tilt * random.normal(), 0})),
                  {pose.translation.x() + noise * random.normal(),
                   pose.translation.y() + noise * random.normal(), 0}};
    };
    const std::int64_t time = 100'000 * i;
    result.a.push_back({time, to_dual_quaternion(level(body))});
    result.b.push_back({time, to_dual_quaternion(level(tilted))});
  }
  return result;
}

}  // namespace egocal::testing
