// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A train on a line with wide curves, whose odometries turn by noise: right streams, of one drive.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/findings.hpp"
#include "../support/turning_bodies.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_turning_in_noise {
namespace {

using testing::find;

/// Two sensors on one train, or each on its own. rotation_noise: of each step of 0.05 s [rad].
testing::Streams trains(std::uint64_t seed, double rotation_noise, bool one) {
  const auto streams = [&](std::uint64_t of_drive) {
    testing::Random random(of_drive);
    const testing::Shaking speed(random, 0.02, 0.05, 2.5), yaw_rate(random, 0.02, 0.05, 0.01);
    testing::BodyPath body;
    Pose pose;
    for (int i = 0; i * testing::body_step < 71; ++i) {
      const double t = i * testing::body_step;
      body.push_back(pose);
      pose = pose * Pose{rotation_exp({0, 0, testing::body_step * yaw_rate.at(t)}),
                         {testing::body_step * (15 + speed.at(t)), 0, 0}};
    }
    const auto sensor = [&](const Pose& mount) {
      return testing::Sensor{mount, 20, 0, 0, rotation_noise, 0.005};
    };
    const Pose T_a{rotation_exp(random.normal3(1)), random.normal3(1)},
        T_b{rotation_exp(random.normal3(1)), random.normal3(1)};
    return testing::Streams{to_dual_quaternion(inverse(T_a) * T_b),
                            testing::measured(random, body, 70, sensor(T_a)),
                            testing::measured(random, body, 70, sensor(T_b)),
                            {}};
  };
  testing::Streams result = streams(seed);
  if (!one) result.b = streams(seed + 1000).b;
  return result;
}

TEST(TurningInNoise, IsTooLittleMotionAndNotAnotherDrive) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const testing::Streams streams = trains(seed, 0.006, true);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(find(calibration, "unrelated"), nullptr) << seed << ": " << calibration.reason;
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
    named += find(calibration, "too_little_motion") != nullptr;
  }
  EXPECT_GE(named, 8);
}

TEST(TurningInNoise, OfTwoTrainsIsNotOfOne) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const testing::Streams streams = trains(seed, 0.006, false);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
    EXPECT_NE(find(calibration, "unrelated"), nullptr) << seed << ": " << calibration.reason;
  }
}

/// Two sensors of a slow car, or of two cars: steps of 5 cm that turn by noise.
testing::Streams slow_cars(std::uint64_t seed, double rotation_noise, bool one) {
  SimulationOptions options;
  options.poses = 600;
  options.rate = 20;
  options.speed = 1;
  options.seed = seed;
  options.noise_rotation = rotation_noise;
  options.noise_translation = 0.003;
  testing::Streams result = testing::simulated_drive(options);
  options.seed = seed + 1000;
  if (!one) result.b = testing::simulated_drive(options).b;
  return result;
}

/// At one speed they do not show that they travel together; but what they turn unlike is no more than noise.
TEST(TurningInNoise, OfASlowCarIsNotAnotherDrive) {
  int contradicted = 0;  // noise may look like a mount that moved
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const double noise : {0.0009, 0.0018, 0.0035}) {
      const testing::Streams streams = slow_cars(seed, noise, true);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_EQ(find(calibration, "unrelated"), nullptr)
          << seed << ", " << noise << ": " << calibration.reason;
      EXPECT_LT(calibration.verdict, Verdict::contradictory)
          << seed << ", " << noise << ": " << calibration.reason;
      contradicted += calibration.verdict > Verdict::incomplete;
    }
  EXPECT_LE(contradicted, 1);
}

TEST(TurningInNoise, OfTwoSlowCarsIsLessThanWhatTheyTurnUnlike) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const testing::Streams streams = slow_cars(seed, 0.0003, false);
    EXPECT_EQ(calibrate(streams.a, streams.b).verdict, Verdict::contradictory) << seed;
  }
}

/// A parked car: whatever its sensors measure is noise, which contradicts every extrinsic.
TEST(TurningInNoise, OfSensorsThatStandIsTooLittleMotion) {
  testing::Random random(1);
  testing::Streams streams;
  for (int i = 0; i < 600; ++i)
    for (Trajectory* stream : {&streams.a, &streams.b})
      stream->push_back({static_cast<std::int64_t>(i) * 100'000,
                         canonical_sign(testing::displacement(random.normal3(0.003), random.normal3(0.02)))});
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
  EXPECT_NE(find(calibration, "too_little_motion"), nullptr) << calibration.reason;
  EXPECT_NE(calibration.reason.find("Record a longer drive"), std::string::npos) << calibration.reason;
}

}  // namespace
}  // namespace egocal::test_turning_in_noise
