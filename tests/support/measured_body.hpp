// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a sensor on a moving body reports of its path.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// Poses of a body, one a millisecond.
using BodyPath = std::vector<Pose>;
constexpr double body_step = 1e-3;  ///< [s]

struct Sensor {
  Pose mount;                                    ///< T_body_sensor
  double rate = 10;                              ///< [Hz]
  double phase = 0;                              ///< time of the first pose [s]
  double late = 0;                               ///< added to the stamps [s]
  double noise_angle = 1e-4, noise_step = 2e-3;  ///< of each motion [rad, m]
};

/// Odometry of a sensor until `seconds`. Each motion has noise, which stays in all later poses.
inline Trajectory measured(Random& random, const BodyPath& body, double seconds, const Sensor& sensor) {
  Trajectory poses;
  Pose before, at;
  for (int i = 0; sensor.phase + i / sensor.rate < seconds; ++i) {
    const auto index = static_cast<std::size_t>(std::lround((sensor.phase + i / sensor.rate) / body_step));
    const Pose exact = body[index] * sensor.mount;
    if (i == 0) {
      at = exact;
    } else {
      const Pose noise{rotation_exp(random.normal3(sensor.noise_angle)), random.normal3(sensor.noise_step)};
      at = at * (inverse(before) * exact) * noise;
    }
    before = exact;
    poses.push_back(
        {static_cast<std::int64_t>(index) * 1000 + std::llround(1e6 * sensor.late), to_dual_quaternion(at)});
  }
  return poses;
}

}  // namespace egocal::testing
