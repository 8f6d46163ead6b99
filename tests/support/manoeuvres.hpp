// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

struct ManoeuvresOptions {
  double least_seconds = 40, most_seconds = 150;  ///< of the whole drive
  double lever_arm = 6;                           ///< of the sensors, at most [m]
  double noise = 0.01;                            ///< of the root mean square step
};

/// Manoeuvres of 4 to 25 s in random order, as in a calibration drive: standing, straight, turning on the
/// spot, a curve; with a hand-held rig also rocking, heaving, sliding, any motion. Each shows other
/// directions.
inline Streams manoeuvres(std::uint64_t seed, bool by_hand, const ManoeuvresOptions& options) {
  constexpr double period = 0.1;
  Random random(seed);
  const auto mount = [&] {
    return testing::random_displacement(random, 1.5, options.lever_arm * random.uniform());
  };
  const DualQuaternion T_a = mount(), T_b = mount();
  const double seconds = random.uniform(options.least_seconds, options.most_seconds);
  std::vector<DualQuaternion> steps;
  double begin = 0, end = 0, frequency = 1, turns = 0, ways = 0;
  std::uint64_t kind = 0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), way = turn;
  for (int i = 1; i * period <= seconds; ++i) {
    const double t = i * period;
    if (t >= end) {
      begin = t;
      end = t + random.uniform(4, 25);
      kind = random.below(by_hand ? 8 : 4);
      turn = random.normal3();
      way = random.normal3();
      frequency = random.uniform(0.1, 0.8);
    }
    const double swing = std::cos(2 * std::numbers::pi * frequency * (t - begin));
    Eigen::Vector3d w = Eigen::Vector3d::Zero(), v = w;
    if (kind == 1) v[0] = 1 + 3 * std::abs(way[0]);
    if (kind == 2) w[2] = 0.4 * turn[2];
    if (kind == 3) v[0] = 1 + 2 * std::abs(way[0]), w[2] = 0.25 * turn[2];
    if (kind == 4) w = 0.4 * swing * turn;
    if (kind == 5) v[2] = swing;
    if (kind == 6) v[1] = swing;
    if (kind == 7) w = 0.3 * swing * turn, v = swing * way;
    // softly, and over rough ground
    const double part = std::min({1.0, t - begin, end - t});
    w *= part;
    v *= part;
    w += std::min(1.0, v.norm()) *
         Eigen::Vector3d(0.02 * std::sin(9 * t), 0.012 * std::sin(11 * t), 0.004 * std::sin(5 * t));
    steps.push_back(displacement(w * period, v * period));
    turns += std::pow(rotation_angle(steps.back()), 2) / (seconds / period);
    ways += to_pose(steps.back()).translation.squaredNorm() / (seconds / period);
  }
  Streams streams;
  streams.T = conjugate(T_a) * T_b;
  DualQuaternion a, b;
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    const auto time_us = static_cast<std::int64_t>(i) * 100'000;
    streams.a.push_back({time_us, a});
    streams.b.push_back({time_us, b});
    if (i == steps.size()) break;
    const auto measured = [&](const DualQuaternion& T) {
      const Eigen::Vector3d turned = random.normal3(options.noise * std::max(1e-4, std::sqrt(turns / 3)));
      const Eigen::Vector3d moved = random.normal3(options.noise * std::max(1e-3, std::sqrt(ways / 3)));
      return conjugate(T) * steps[i] * T * displacement(turned, moved);
    };
    a = a * measured(T_a);
    b = b * measured(T_b);
  }
  return streams;
}

}  // namespace egocal::testing
