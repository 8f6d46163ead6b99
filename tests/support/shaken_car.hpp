// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A car whose body pitches, rolls and heaves as fast as its sensors can just measure.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "measured_body.hpp"
#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// A sum of sines with a given root mean square.
class Shaking {
 public:
  Shaking(Random& random, double lowest_hz, double highest_hz, double size) {
    double squares = 0;
    for (Sine& sine : sines_) {
      sine = {random.normal(), 2 * std::numbers::pi * random.log_uniform(lowest_hz, highest_hz),
              random.uniform(0, 2 * std::numbers::pi)};
      squares += 0.5 * sine.size * sine.size;
    }
    for (Sine& sine : sines_) sine.size *= size / std::sqrt(squares);
  }
  double at(double t) const {
    double sum = 0;
    for (const Sine& sine : sines_) sum += sine.size * std::sin(sine.rate * t + sine.phase);
    return sum;
  }

 private:
  struct Sine {
    double size = 0, rate = 0, phase = 0;
  };
  std::array<Sine, 12> sines_{};
};

struct ShakenCar {
  double rate_a = 10, rate_b = 20;               ///< [Hz]
  double phase_b = 0.013;                        ///< time of b's first pose [s]; that of a's is 0
  double lowest = 1, highest = 3;                ///< of pitch and roll [Hz]
  double seconds = 60, size = 0.015;             ///< root mean square of pitch and roll [rad]
  double noise_angle = 1e-4, noise_step = 2e-3;  ///< of each motion [rad, m]
  std::uint64_t seed = 1;
};

inline Streams shaken_car(const ShakenCar& car) {
  Random random(car.seed);
  const Shaking turn(random, 0.02, 0.12, 0.4), heave(random, 0.1, 0.8, 0.08),
      pitch(random, car.lowest, car.highest, car.size), roll(random, car.lowest, car.highest, car.size),
      slow_pitch(random, 0.1, 1, 0.015), slow_roll(random, 0.1, 1, 0.015);
  BodyPath body;
  double x = 0, y = 0;
  for (int i = 0; i * body_step < car.seconds + 1; ++i) {
    const double t = i * body_step, yaw = turn.at(t);
    x += 8 * body_step * std::cos(yaw);
    y += 8 * body_step * std::sin(yaw);
    const Rotation turned = rotation_exp({0, 0, yaw}) * rotation_exp({0, pitch.at(t) + slow_pitch.at(t), 0}) *
                            rotation_exp({roll.at(t) + slow_roll.at(t), 0, 0});
    body.push_back({turned, {x, y, heave.at(t)}});
  }
  const Sensor a{T_vehicle_a, car.rate_a, 0, 0, car.noise_angle, car.noise_step},
      b{T_vehicle_b, car.rate_b, car.phase_b, 0, car.noise_angle, car.noise_step};
  return {to_dual_quaternion(inverse(T_vehicle_a) * T_vehicle_b),
          measured(random, body, car.seconds, a),
          measured(random, body, car.seconds, b),
          {}};
}

}  // namespace egocal::testing
