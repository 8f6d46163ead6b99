// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// 10 s straight on at 8 m/s with small tilts, and a quarter turn in the last twelfth, so that few motions
/// hold the information about most directions. White noise of 2 mrad and 1 cm on every motion of both
/// sensors.
inline Streams one_turn_drive(std::uint64_t seed) {
  constexpr int motions = 100, first_turning = 88;
  constexpr double tilt = 0.004, yaw = 0.13;                    // [rad]
  constexpr double noise_rotation = 0.002, noise_shift = 0.01;  // [rad, m]
  Random random(seed);
  Streams streams;
  streams.T = to_dual_quaternion(inverse(T_vehicle_a) * T_vehicle_b);
  const DualQuaternion T_a = to_dual_quaternion(T_vehicle_a);
  DualQuaternion pose_a, pose_b;
  streams.a.push_back({0, pose_a});
  streams.b.push_back({0, pose_b});
  for (int i = 0; i < motions; ++i) {
    Eigen::Vector3d turn = random.normal3(tilt);
    if (i >= first_turning) turn.z() = yaw;
    const Eigen::Vector3d scatter = random.normal3();
    const Eigen::Vector3d shift(0.8 + 0.05 * scatter.x(), 0.01 * scatter.y(), 0.02 * scatter.z());
    const DualQuaternion motion_a = conjugate(T_a) * displacement(turn, shift) * T_a;
    const DualQuaternion motion_b = conjugate(streams.T) * motion_a * streams.T;
    const auto noise = [&random] {
      const Eigen::Vector3d rotation = random.normal3(noise_rotation),
                            translation = random.normal3(noise_shift);
      return displacement(rotation, translation);
    };
    pose_a = pose_a * motion_a * noise();
    pose_b = pose_b * motion_b * noise();
    const std::int64_t time_us = (i + 1) * 100'000;
    streams.a.push_back({time_us, pose_a});
    streams.b.push_back({time_us, pose_b});
  }
  return streams;
}

}  // namespace egocal::testing
