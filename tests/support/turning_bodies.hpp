// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bodies that turn about changing axes: one that floats freely, one that is held at a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "measured_body.hpp"
#include "random_motion.hpp"
#include "shaken_car.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// Two sensors that measure the path of a body, each with noise of this part of its usual step.
inline Streams two_sensors(Random& random, const BodyPath& body, double seconds, double noise,
                           double rate_b = 20) {
  const Pose T_a{rotation_exp(random.normal3(1)), random.uniform(0.3, 2) * random.direction()};
  const Pose T_b{rotation_exp(random.normal3(1)), random.uniform(0.3, 2) * random.direction()};
  const auto sensor = [&](const Pose& mount, double rate) {
    const auto step = static_cast<std::size_t>(std::lround(1 / (rate * body_step)));
    double angle = 0, length = 0, count = 0;
    for (std::size_t i = 0; i + step < body.size(); i += step, count += 1) {
      const Pose motion = inverse(body[i] * mount) * (body[i + step] * mount);
      angle += Eigen::AngleAxisd(motion.rotation).angle();
      length += motion.translation.norm();
    }
    return Sensor{mount, rate, 0, 0, noise * angle / count, noise * length / count};
  };
  return {to_dual_quaternion(inverse(T_a) * T_b),
          measured(random, body, seconds, sensor(T_a, 20)),
          measured(random, body, seconds, sensor(T_b, rate_b)),
          {}};
}

/// A satellite without a drive: Euler's equations without torque; its centre drifts evenly. [s, m, m/s]
struct Tumbling {
  double seconds = 45, distance = 10, drift = 0.3, turning = 0.5;  ///< distance: at first, from the origin
  double noise = 0.005;
  std::uint64_t seed = 1;
};

inline Streams tumbling(const Tumbling& options) {
  Random random(options.seed);
  const Eigen::Vector3d inertia(random.uniform(0.5, 2), random.uniform(0.5, 2), random.uniform(0.5, 2));
  Eigen::Vector3d rate = options.turning * random.direction();
  const Eigen::Vector3d begin = options.distance * random.direction(),
                        velocity = options.drift * random.direction();
  Rotation turned = rotation_exp(random.normal3(1));
  BodyPath body;
  for (int i = 0; i * body_step < options.seconds + 1; ++i) {
    body.push_back({turned, begin + i * body_step * velocity});
    turned = (turned * rotation_exp(body_step * rate)).normalized();
    const Eigen::Vector3d momentum = inertia.cwiseProduct(rate);
    rate += body_step * momentum.cross(rate).cwiseQuotient(inertia);
  }
  return two_sensors(random, body, options.seconds, options.noise);
}

/// A head that pans and tilts about one point.
inline Streams pan_tilt(std::uint64_t seed, double noise, double seconds = 40) {
  Random random(seed);
  const Shaking pan(random, 0.03, 0.3, random.uniform(0.4, 1.2)),
      tilt(random, 0.03, 0.4, random.uniform(0.1, 0.5));
  const Eigen::Vector3d point = random.normal3(5);
  BodyPath body;
  for (int i = 0; i * body_step < seconds + 1; ++i) {
    const double t = i * body_step;
    body.push_back({rotation_exp({0, 0, pan.at(t)}) * rotation_exp({0, tilt.at(t), 0}), point});
  }
  return two_sensors(random, body, seconds, noise);
}

}  // namespace egocal::testing
