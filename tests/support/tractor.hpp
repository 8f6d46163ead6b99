// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A tractor that goes up and down a field at one speed, and rolls and pitches on it.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "random_motion.hpp"
#include "shaken_car.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// A tractor in rows of 33 s, four minutes at 10 Hz, with little noise. The mount of b bends by `bent` [rad],
/// half of it in the first quarter.
inline Streams tractor(std::uint64_t seed, double bent) {
  constexpr double period = 0.1, seconds = 240;
  Random random(seed);
  const Shaking roll(random, 0.2, 1, 0.03), pitch(random, 0.2, 1, 0.03), slope(random, 0.01, 0.05, 0.04);
  const DualQuaternion T_a = displacement(random.normal3(1), random.normal3(0.03)),
                       T_b = displacement(random.normal3(1), random.normal3(0.03));
  const Eigen::Vector3d axis = random.direction();
  Streams streams;
  streams.T = conjugate(T_a) * T_b;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double heading = 0;
  for (int i = 0; i < static_cast<int>(seconds / period); ++i) {
    const double t = period * i, in_row = std::fmod(t, 40.0), side = std::fmod(t, 80.0) < 40 ? 1 : -1;
    if (in_row > 33)
      heading += side * period * 0.45 * (1 - std::cos(2 * std::numbers::pi * (in_row - 33) / 7));
    const double up = slope.at(t);
    place += 2.2 * period * Eigen::Vector3d(std::cos(heading), std::sin(heading), -up);
    const DualQuaternion body = displacement({0, 0, heading}, place) *
                                displacement({0, pitch.at(t) + up, 0}, {0, 0, 0}) *
                                displacement({roll.at(t), 0, 0}, {0, 0, 0});
    const DualQuaternion bend = displacement(bent * (1 - std::exp2(-4 * t / seconds)) * axis, {0, 0, 0});
    const auto measured = [&](const DualQuaternion& T) {
      return canonical_sign(normalized(body * T * displacement(random.normal3(1e-4), random.normal3(2e-3))));
    };
    const auto time_us = std::int64_t{100'000} * i;
    streams.a.push_back({time_us, measured(T_a)});
    streams.b.push_back({time_us, measured(T_b * bend)});
  }
  return streams;
}

}  // namespace egocal::testing
