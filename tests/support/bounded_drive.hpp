// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "mistakes.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

/// A hand-held rig that stays within some metres: noise does not grow with the distance from the start.
inline Streams bounded_drive() {
  Streams streams;
  const Pose T_rig_a = T_vehicle_a, T_rig_b = T_vehicle_b;
  streams.T = to_dual_quaternion(inverse(T_rig_a) * T_rig_b);
  Random random(5);
  for (int i = 0; i < 901; ++i) {
    const double t = 0.1 * i;
    const Eigen::Vector3d turn(0.35 * std::sin(0.7 * t) + 0.2 * std::sin(1.9 * t + 1),
                               0.35 * std::sin(0.9 * t + 2), 0.8 * std::sin(0.31 * t));
    const Eigen::Vector3d place(2.5 * std::sin(0.4 * t), 2 * std::sin(0.53 * t + 1),
                                1.5 * std::sin(0.67 * t + 2));
    const Pose rig{rotation_exp(turn), place};
    const auto noise = [&] { return Pose{rotation_exp(random.normal3(0.001)), random.normal3(0.002)}; };
    const auto time_us = static_cast<std::int64_t>(i) * 100'000;
    streams.a.push_back({time_us, canonical_sign(to_dual_quaternion(rig * T_rig_a * noise()))});
    streams.b.push_back({time_us, canonical_sign(to_dual_quaternion(rig * T_rig_b * noise()))});
  }
  return streams;
}

}  // namespace egocal::testing
