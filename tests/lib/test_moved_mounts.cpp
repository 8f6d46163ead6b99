// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that moves is named with its time and size, and what only looks like a move is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

#include "../support/findings.hpp"
#include "../support/manoeuvres.hpp"
#include "../support/mistakes.hpp"
#include "../support/moved_drive.hpp"
#include "../support/random_motion.hpp"
#include "../support/shaken_car.hpp"
#include "../support/turning_machine.hpp"
#include "diagnosis/mount/mount.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_moved_mounts {
namespace {

using testing::drive;
using testing::find;

/// A drive with 1 % noise in which the mount of b moves at a time [s].
SimulationOptions moved_at(double time, const Pose& change, int poses) {
  SimulationOptions simulation;
  simulation.poses = poses;
  simulation.relative_noise = 0.01;
  simulation.faults.resize(2);
  simulation.faults[1].mount_changes = {{time, time, change}};
  return simulation;
}

TEST(MovedMount, AMovedMountIsFoundAtItsTime) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0.06, 0}), {0, 0.1, 0}});
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* moved = find(calibration, "mount_moved");
  ASSERT_NE(moved, nullptr) << calibration.reason;
  EXPECT_NEAR(*moved->time, 30, 4);
  EXPECT_GE(calibration.verdict, Verdict::doubtful);
}

/// The sensor of b moved by an amount that depends on the time in microseconds since its first pose.
testing::Streams with_moving_mount(const std::function<Pose(std::int64_t)>& moved) {
  testing::Streams streams = drive(Terrain::free);
  const std::int64_t begin_us = streams.b.front().time_us;
  for (StampedPose& pose : streams.b)
    pose.pose = canonical_sign(normalized(pose.pose * to_dual_quaternion(moved(pose.time_us - begin_us))));
  return streams;
}

/// Turned about an axis by an angle that depends on the time [s].
testing::Streams shaken(const std::function<double(double)>& angle) {
  return with_moving_mount([&](std::int64_t time_us) {
    return Pose{rotation_exp(angle(1e-6 * static_cast<double>(time_us)) * Eigen::Vector3d(0.6, 0.8, 0)),
                Eigen::Vector3d::Zero()};
  });
}

/// A loose bolt: another place in every second stretch of 7 s. The one answer lies between both.
TEST(MovedMount, AMountThatGoesBackAndForthIsNamed) {
  const testing::Streams still = drive(Terrain::free);
  EXPECT_LE(calibrate(still.a, still.b).verdict, Verdict::incomplete);
  const testing::Streams streams = with_moving_mount([](std::int64_t time_us) {
    return time_us / 7'000'000 % 2 == 1 ? Pose{rotation_exp({0.03, 0.05, 0}), {0, 0.05, 0}} : Pose{};
  });
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
  const Finding* moved = find(calibration, "mount_moved");
  ASSERT_NE(moved, nullptr) << calibration.reason;
  EXPECT_TRUE(moved->certain);
  EXPECT_NE(moved->message.find("back and forth between two places, 8 times"), std::string::npos)
      << moved->message;
  EXPECT_NEAR(*moved->time, 7, 2);
  ASSERT_TRUE(moved->T_a_b);
  EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*moved->T_a_b)).rotation, 0.005);
}

/// Faster than blocks of motions can follow, or between more than two places.
TEST(MovedMount, AMountThatShakesIsDoubtful) {
  const auto flaps = [](double t) { return static_cast<long>(t) % 2 == 1 ? 0.035 : -0.035; };
  const auto sways = [](double t) { return 0.035 * std::sin(2 * std::numbers::pi * t / 8); };
  for (const std::function<double(double)>& angle : {std::function<double(double)>(flaps), {sways}}) {
    const testing::Streams streams = shaken(angle);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
    const Finding* moved = find(calibration, "mount_moved");
    ASSERT_NE(moved, nullptr) << calibration.reason;
    EXPECT_FALSE(moved->certain);
    EXPECT_NE(moved->message.find("The rotation between the sensors changes by "), std::string::npos)
        << moved->message;
  }
}

/// An attitude that errs by half a degree for eight seconds, one that drifts by degrees, and noise of 2 deg
/// in single poses.
TEST(MovedMount, RotationsThatErrDoNotShake) {
  constexpr double period = 0.1;
  testing::Random random(5);
  double error = 0, drift = 0;
  std::vector<double> errors, drifts, noise;
  for (int i = 0; i < 2000; ++i) {
    const double forgotten = period / 8;
    error += -forgotten * error + std::sqrt(2 * forgotten) * 0.009 * random.normal();
    drift += std::sqrt(period) * 0.01 * random.normal();
    errors.push_back(error);
    drifts.push_back(drift);
    noise.push_back(0.035 * random.normal());
  }
  for (const std::vector<double>* angles : {&errors, &drifts, &noise}) {
    const testing::Streams streams = shaken([&](double t) {
      return (*angles)[std::min(angles->size() - 1, static_cast<std::size_t>(t / period))];
    });
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* moved = find(calibration, "mount_moved");
    EXPECT_EQ(moved, nullptr) << moved->message;
  }
}

/// A car in town, two minutes at 10 Hz, whose sensors find their poses in a map: noise of 0.3 deg and 3 cm
/// per axis on each pose, as much as a single step turns.
testing::Streams noisy_poses(std::uint64_t seed) {
  constexpr double period = 0.1;
  testing::Random random(seed);
  const DualQuaternion T_a = testing::random_displacement(random, 1, 1),
                       T_b = testing::random_displacement(random, 1, 1);
  const testing::Shaking speed(random, 0.02, 0.1, 3), bend(random, 0.03, 0.2, 0.02),
      pitch(random, 0.1, 0.8, 0.02), roll(random, 0.1, 0.8, 0.02);
  testing::Streams streams;
  streams.T = conjugate(T_a) * T_b;
  DualQuaternion car;
  for (int i = 0; i <= 1200; ++i) {
    const double t = i * period, way = period * std::max(0.0, 6 + speed.at(t));
    const auto measured = [&](const DualQuaternion& T) {
      return canonical_sign(car * T * testing::displacement(random.normal3(0.005), random.normal3(0.03)));
    };
    const auto time_us = static_cast<std::int64_t>(i) * 100'000;
    streams.a.push_back({time_us, measured(T_a)});
    streams.b.push_back({time_us, measured(T_b)});
    car = car *
          testing::displacement({period * roll.at(t), period * pitch.at(t), way * bend.at(t)}, {way, 0, 0});
  }
  return streams;
}

TEST(MovedMount, EvidenceThatNoMoveExplainsIsNamedWithoutATime) {
  const DiagnosisOptions options;
  EXPECT_FALSE(detail::contradicting_times(1e-6, options));
  const std::optional<Finding> finding = detail::contradicting_times(1e-30, options);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, "mount_moved");
  EXPECT_FALSE(finding->certain);
  EXPECT_FALSE(finding->time);
  EXPECT_NE(finding->message.find("one of 1e+30 drives"), std::string::npos) << finding->message;
  EXPECT_TRUE(detail::contradicting_times(0, options));  // as where it is smaller than any double
}

TEST(MovedMount, NoiseOfPosesIsNoMove) {
  for (std::uint64_t seed = 9; seed <= 20; ++seed) {
    const testing::Streams streams = noisy_poses(seed);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
  }
}

/// Straight on for 22 s, 19 s still, eight seconds of turning on the spot, still again: the first part says
/// nothing of the rotation about the direction of travel, the second one nothing of that about the vertical.
/// Noise is remembered for a second.
testing::Streams straight_then_turning(std::uint64_t seed) {
  constexpr double period = 0.05, kept = 0.95;
  testing::Random random(seed);
  const std::array<DualQuaternion, 2> mounts{testing::random_extrinsic(random),
                                             testing::random_extrinsic(random)};
  std::array<Eigen::Vector3d, 2> turn_noise{random.normal3(1), random.normal3(1)},
      shift_noise{random.normal3(1), random.normal3(1)};
  std::array<DualQuaternion, 2> poses;
  testing::Streams streams;
  streams.T = conjugate(mounts[0]) * mounts[1];
  for (int i = 0; i <= 1200; ++i) {
    const double t = i * period, speed = t < 22 ? 2.5 : 0, rate = t > 41 && t < 49 ? 0.25 : 0;
    const DualQuaternion step = testing::displacement(
        {0.001 * std::sin(9 * t), 0.0006 * std::sin(11 * t), rate * period}, {speed * period, 0, 0});
    for (std::size_t k = 0; k < 2; ++k) {
      for (Eigen::Vector3d* noise : {&turn_noise[k], &shift_noise[k]})
        *noise = kept * *noise + random.normal3(std::sqrt(1 - kept * kept));
      if (i > 0)
        poses[k] = poses[k] * (conjugate(mounts[k]) * step * mounts[k]) *
                   testing::displacement(0.0002 * turn_noise[k], 0.0015 * shift_noise[k]);
    }
    const auto time_us = static_cast<std::int64_t>(std::llround(1e6 * t));
    streams.a.push_back({time_us, poses[0]});
    streams.b.push_back({time_us, poses[1]});
  }
  return streams;
}

TEST(MovedMount, PartsThatShowDifferentDirectionsAreNoMove) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const testing::Streams streams = straight_then_turning(seed);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
  }
}

// Rotation noise pulls lever arms of metres, in each manoeuvre otherwise: of 238 such drives these five had a
// move by metres, or by any angle.
TEST(MovedMount, LongLeverArmsInNoiseAreNoMove) {
  for (const std::uint64_t seed : {30, 32, 33, 114, 115}) {
    const testing::Streams streams = testing::manoeuvres(seed, true, {.noise = 0.1});
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
  }
}

// A tenth of every motion is noise, and remembered for ten of them.
TEST(MovedMount, StrongNoiseThatWandersInAShortDriveIsNoMove) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::flat;
  simulation.relative_noise = 0.1;
  simulation.random_walk = true;
  simulation.poses = 301;
  const auto expect_no_finding = [&](std::uint64_t seed) {
    simulation.seed = seed;
    const testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
  };
  for (const std::uint64_t seed : {5, 6, 111, 123}) expect_no_finding(seed);
  simulation.faults.resize(2);
  simulation.faults[1].rate = 7;
  simulation.faults[1].phase = 0.37 / 7;
  for (const std::uint64_t seed : {1, 4}) expect_no_finding(seed);
}

// Of the same kind of noise, remembered for 6 s, and of one drive in which it looks like a move.
TEST(MovedMount, WhatNoiseMayHaveMadeIsPossible) {
  int possible = 0;
  for (std::uint64_t seed = 1; seed <= 60 && possible == 0; ++seed) {
    SimulationOptions options =
        testing::moved_drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, 5000 + seed, 30);
    options.relative_noise = 0.005;
    const auto streams = simulate(options);
    const Calibration calibration = calibrate(testing::with_wandering_errors(streams[0], seed), streams[1]);
    const Finding* moved = find(calibration, "mount_moved");
    if (moved == nullptr || moved->certain) continue;
    ++possible;
    EXPECT_LE(calibration.verdict, Verdict::doubtful);
    EXPECT_THAT(moved->message, ::testing::HasSubstr("seems to"));
    EXPECT_THAT(moved->message, ::testing::HasSubstr("Noise that wanders for as long may look the same."));
  }
  EXPECT_EQ(possible, 1);
}

// What a look at a drive shows that is judged again every two seconds.
TEST(MovedMount, AScaleThatJumpsIsNoMove) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      SimulationOptions simulation;
      simulation.terrain = terrain;
      simulation.poses = 901;
      simulation.speed_variation = 1;
      simulation.relative_noise = 0.01;
      simulation.seed = seed;
      testing::Streams streams = testing::simulated_drive(simulation);
      streams.b = testing::longer_from_the_middle(streams.b, 1.3);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
      EXPECT_EQ(find(calibration, "mount_moved"), nullptr) << seed << ": " << calibration.reason;
      const Finding* changed = find(calibration, "scale_change");
      ASSERT_NE(changed, nullptr) << seed << ": " << calibration.reason;
      EXPECT_TRUE(changed->certain);
      EXPECT_NEAR(*changed->time, 45, 8) << seed << ": between two turns little shows it";
      const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*changed->T_a_b));
      EXPECT_LT(error.rotation, 0.01) << seed;
      EXPECT_LT(error.translation, terrain == Terrain::free ? 0.1 : 0.8) << seed;
    }
}

// Of a machine that mostly turns in place the extrinsic at one scale is too far off to show where the scale
// changes, but that of a part before or after it is not.
TEST(MovedMount, AScaleThatJumpsOnATurningMachineIsNoMove) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    testing::Streams streams = testing::turning_machine(seed, 1, 0.01);
    for (Trajectory* stream : {&streams.a, &streams.b}) stream->resize(901);
    streams.b = testing::longer_from_the_middle(streams.b, 1.3);
    const double middle = 45;
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
    EXPECT_EQ(find(calibration, "mount_moved"), nullptr) << seed << ": " << calibration.reason;
    const Finding* changed = find(calibration, "scale_change");
    ASSERT_NE(changed, nullptr) << seed << ": " << calibration.reason;
    EXPECT_NEAR(*changed->time, middle, 8) << seed << ": " << calibration.reason;
  }
}

// The mounts of streams that are world-to-sensor seem to move where their odometry drifts. A bump of streams
// as they should be shows under one reading alone as well, but fits it better.
TEST(MovedMount, StreamsThatMayBothBeInvertedMoveForCertainOnlyWhereThatFitsBetter) {
  int uncertain = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SimulationOptions simulation = moved_at(45, {rotation_exp({0, 0.02, 0}), {0.03, 0, 0}}, 901);
    simulation.terrain = Terrain::free;
    simulation.speed = 1;
    simulation.seed = seed;
    testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration knocked = calibrate(streams.a, streams.b);
    const Finding* moved = find(knocked, "mount_moved");
    ASSERT_NE(moved, nullptr) << seed << ": " << knocked.reason;
    EXPECT_TRUE(moved->certain) << seed << ": " << knocked.reason;

    simulation.faults = {};
    streams = testing::simulated_drive(simulation);
    for (Trajectory* stream : {&streams.a, &streams.b})
      for (StampedPose& stamped : *stream) stamped.pose = conjugate(stamped.pose);
    const Calibration inverted = calibrate(streams.a, streams.b);
    EXPECT_NE(find(inverted, "inverted_both"), nullptr) << seed << ": " << inverted.reason;
    moved = find(inverted, "mount_moved");
    if (!moved) continue;
    ++uncertain;
    EXPECT_FALSE(moved->certain) << seed << ": " << inverted.reason;
    EXPECT_GE(inverted.verdict, Verdict::doubtful) << seed;
    const Finding* both = find(inverted, "inverted_both");
    EXPECT_NE(both->message.find("the mounting did not change"), std::string::npos) << both->message;
  }
  EXPECT_GE(uncertain, 2) << "mounts seem to move where odometry drifts";
}

TEST(MovedMount, AMoveMustHaveShownBefore) {
  SimulationOptions simulation = moved_at(110, {rotation_exp({0, 0.02, 0}), {0.06, 0, 0}}, 1201);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    simulation.seed = seed;
    const testing::Streams streams = testing::simulated_drive(simulation);
    const auto named = [&](double shown_before) {
      CalibrationOptions options;
      options.diagnosis.mount.shown_before = shown_before;
      const Calibration calibration = calibrate(streams.a, streams.b, options);
      const Finding* moved = find(calibration, "mount_moved");
      if (moved) {
        EXPECT_NEAR(*moved->time, 110, 4);
      }
      return moved != nullptr;
    };
    EXPECT_TRUE(named(0));
    EXPECT_TRUE(named(2));
    EXPECT_FALSE(named(9.5)) << "half a second after it nothing shows it";
  }
}

TEST(MovedMount, TheSizeOfAMoveIsWhatTheMotionsShowOfIt) {
  SimulationOptions simulation = moved_at(120, {rotation_exp({0, 0.015, 0}), {0, 0, 0.03}}, 1261);
  int stated = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    simulation.seed = seed;
    const testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* moved = find(calibration, "mount_moved");
    if (!moved) continue;
    ++stated;
    double turn = 0, shift = 0;
    const int numbers =
        std::sscanf(moved->message.c_str(), "The mounting changed by %lf deg and %lf cm", &turn, &shift);
    ASSERT_GE(numbers, 1) << moved->message;
    EXPECT_NEAR(turn, 0.86, 0.4) << moved->message;
    EXPECT_LT(shift, 60) << "a road hardly shows the height in six seconds: " << moved->message;
  }
  EXPECT_GE(stated, 6);
}

}  // namespace
}  // namespace egocal::test_moved_mounts
