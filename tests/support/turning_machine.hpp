// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include "egocal/scale/scale_statistics.hpp"
#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// Two sensors on the cab of an excavator, three minutes at 10 Hz: it swings, rocks while it digs, and creeps
/// a few metres in one of six turns of work. Except while it creeps, a wrong scale with other lever arms
/// explains the same motions. Noise: a part of each motion. scale_b: of the positions of b.
inline Streams turning_machine(std::uint64_t seed, double scale_b, double noise = 0.003) {
  constexpr int poses = 1801;
  constexpr double period = 0.1, work = 5;  // [s]
  Random random(seed);
  const DualQuaternion T_a = displacement({0.02, -0.01, 0.01}, {0.5, 0.3, 2.5});
  const DualQuaternion T_b = displacement({0.03, 0.02, 0.6}, {1.2, -0.5, 2});
  Streams streams;
  streams.T = conjugate(T_a) * T_b;
  DualQuaternion pose_a, pose_b, cab;
  double swing = 0, creep = 0, yaw = 0, x = 0;
  for (int i = 0; i < poses; ++i) {
    const double t = i * period, in_work = std::fmod(t, work);
    if (in_work < 0.5 * period) {
      swing = creep = 0;
      if (static_cast<int>(t / work + 0.5) % 6 == 5)
        creep = random.uniform(0.3, 0.8) * (random.uniform() < 0.5 ? -1 : 1);
      else
        swing = random.uniform(-1.9, 1.9) - yaw;
    }
    // each piece of work lasts four of five seconds and begins and ends softly
    constexpr double active = 4;
    const double phase = 2 * std::numbers::pi * in_work / active;
    const double rate = in_work < active ? (1 - std::cos(phase)) / active : 0;
    yaw += swing * rate * period;
    x += creep * active * rate * period;
    const double rock = 0.012 * (std::sin(2.9 * t) + std::sin(4.7 * t + 1));
    const DualQuaternion now = displacement({0, 0, 0}, {x, 0, 0.01 * std::sin(3.3 * t)}) *
                               displacement({0.7 * rock, 0, 0}, {0, 0, 0}) *
                               displacement({0, rock + 0.01 * std::sin(2.1 * t), 0}, {0, 0, 0}) *
                               displacement({0, 0, yaw}, {0, 0, 0});
    if (i > 0) {
      const DualQuaternion step = conjugate(cab) * now;
      const auto measured = [&](const DualQuaternion& T) {
        const DualQuaternion motion = conjugate(T) * step * T;
        const Eigen::Vector3d turn = random.normal3(noise * rotation_angle(motion));
        const Eigen::Vector3d shift = random.normal3(noise * to_pose(motion).translation.norm());
        return motion * displacement(turn, shift);
      };
      pose_a = pose_a * measured(T_a);
      pose_b = pose_b * measured(T_b);
    }
    cab = now;
    const auto time_us = static_cast<std::int64_t>(std::llround(1e6 * t));
    streams.a.push_back({time_us, pose_a});
    streams.b.push_back({time_us, scaled(pose_b, scale_b)});
  }
  return streams;
}

}  // namespace egocal::testing
