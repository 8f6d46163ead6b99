// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How far a drive is from its goal, and what to drive next.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/random.hpp"

namespace egocal::test_goal {
namespace {

constexpr double degree = std::numbers::pi / 180;

Calibration after(int poses, Terrain terrain, const GoalOptions& goal) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = poses;
  options.relative_noise = 0.02;
  const testing::Streams streams = testing::simulated_drive(options);
  CalibrationOptions calibration;
  calibration.diagnosis.goal = goal;
  return calibrate(streams.a, streams.b, calibration);
}

TEST(Goal, IsReachedWhereEveryDirectionIsKnownWellEnough) {
  const Calibration calibration = after(1001, Terrain::free, {1 * degree, 0.5, {}});
  ASSERT_TRUE(calibration.goal);
  EXPECT_TRUE(calibration.goal->reached);
  EXPECT_TRUE(calibration.goal->missing.empty());
  EXPECT_TRUE(calibration.goal->next.empty());
}

TEST(Goal, NamesWhatIsMissingAndHowLongItTakes) {
  const Calibration calibration = after(301, Terrain::free, {1 * degree, 0.002, {}});
  ASSERT_TRUE(calibration.goal);
  EXPECT_FALSE(calibration.goal->reached);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete);
  ASSERT_FALSE(calibration.goal->missing.empty());
  ASSERT_TRUE(calibration.goal->seconds_left);
  EXPECT_GT(*calibration.goal->seconds_left, 30);
  EXPECT_FALSE(calibration.goal->next.empty());
}

TEST(Goal, OnFlatGroundMoreOfTheSameDoesNotHelpButARampDoes) {
  const Calibration calibration = after(1001, Terrain::flat, {0.5 * degree, 0.1, {}});
  ASSERT_TRUE(calibration.goal);
  EXPECT_FALSE(calibration.goal->reached);
  EXPECT_FALSE(calibration.goal->seconds_left);
  ASSERT_FALSE(calibration.goal->missing.empty());
  EXPECT_EQ(calibration.goal->missing.front(), "z");
  EXPECT_NE(calibration.goal->next.find("ramp"), std::string::npos) << calibration.goal->next;
}

TEST(Goal, WhereNoManoeuvreIsMuchFasterTheAdviceIsToGoOn) {
  // the way a vehicle travels shows its yaw; no manoeuvre adds much to that
  const Calibration calibration = after(401, Terrain::rough, {0.02 * degree, 1, {}});
  ASSERT_TRUE(calibration.goal);
  ASSERT_FALSE(calibration.goal->reached);
  ASSERT_TRUE(calibration.goal->seconds_left);
  EXPECT_NE(calibration.goal->next.find("on as before"), std::string::npos) << calibration.goal->next;
}

/// A minute at 20 m/s with slight curves, grades and banks, 10 Hz, and then, where wanted, figures of eight
/// at 3 m/s. a is an odometry (1 % of a motion), b has poses in the world (2 cm, 0.06 deg), so its noise does
/// not add up: a motion says little, and the many motions of a second say more than one.
Calibration after_a_motorway(std::uint64_t seed, double seconds_of_eights) {
  constexpr double period = 0.1;
  Random random(seed);
  testing::Streams streams;
  Pose vehicle, drifting;
  const auto wave = [&](double t, double seconds) {
    return std::sin(2 * std::numbers::pi * (t / seconds + 0.1 * static_cast<double>(seed)));
  };
  const auto tilt = [&](double t) {
    return Eigen::Vector3d(0.5 * degree * wave(t, 11), 0.4 * degree * wave(t, 7), 0);
  };
  const int motions = static_cast<int>(std::lround((60 + seconds_of_eights) / period));
  for (int i = 0; i <= motions; ++i) {
    const double t = period * i;
    const Pose tilted{vehicle.rotation * rotation_exp(tilt(t)), vehicle.translation};
    const Pose b = tilted * testing::T_vehicle_b;
    const Pose seen{b.rotation * rotation_exp(0.001 * random.normal3()),
                    b.translation + 0.02 * random.normal3()};
    const auto time_us = static_cast<std::int64_t>(1e5) * i;
    streams.a.push_back({time_us, to_dual_quaternion(drifting)});
    streams.b.push_back({time_us, to_dual_quaternion(seen)});

    const bool eights = t >= 60;
    const double speed = eights ? 3 : 20;
    const double turning = eights ? 25 * degree * (wave(t, 25) > 0 ? 1 : -1) : 1.5 * degree * wave(t, 40);
    vehicle = vehicle * Pose{rotation_exp({0, 0, period * turning}), {period * speed, 0, 0}};
    const Pose next{vehicle.rotation * rotation_exp(tilt(t + period)), vehicle.translation};
    const Pose motion = inverse(testing::T_vehicle_a) * (inverse(tilted) * next) * Pose(testing::T_vehicle_a);
    const Pose noise{rotation_exp(0.0003 * random.normal3()),
                     0.01 * motion.translation.norm() * random.normal3()};
    drifting = drifting * motion * noise;
    drifting.rotation.normalize();
  }
  CalibrationOptions options;
  options.diagnosis.goal = GoalOptions{0.2 * degree, 0.15, Platform::car};
  return calibrate(streams.a, streams.b, options);
}

TEST(Goal, OnAMotorwayAManoeuvreIsAdvisedThoughItDoesNotShowEveryDirection) {
  for (const std::uint64_t seed : {1, 2}) {
    const Calibration calibration = after_a_motorway(seed, 0);
    ASSERT_TRUE(calibration.goal);
    ASSERT_FALSE(calibration.goal->reached);
    EXPECT_GE(calibration.goal->missing.size(), 2U);
    EXPECT_EQ(calibration.goal->next.find("on as before"), std::string::npos) << "seed " << seed;
    EXPECT_EQ(calibration.goal->next.find("straight"), std::string::npos) << calibration.goal->next;
  }
}

TEST(Goal, WhatAFigureEightDoesNotShowIsAdvisedNext) {
  for (const std::uint64_t seed : {3, 4}) {
    const Calibration calibration = after_a_motorway(seed, 25);
    ASSERT_TRUE(calibration.goal);
    ASSERT_FALSE(calibration.goal->reached);
    EXPECT_EQ(calibration.goal->missing.front(), "z") << "seed " << seed;
    EXPECT_NE(calibration.goal->next.find("ramp"), std::string::npos) << calibration.goal->next;
  }
}

TEST(Goal, ThePlatformChoosesTheWords) {
  const Calibration calibration = after(301, Terrain::flat, {0.1 * degree, 0.01, Platform::arm});
  ASSERT_TRUE(calibration.goal);
  EXPECT_NE(calibration.goal->next.find("hand"), std::string::npos) << calibration.goal->next;
}

}  // namespace
}  // namespace egocal::test_goal
