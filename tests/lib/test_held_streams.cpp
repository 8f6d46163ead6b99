// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams of which one half repeats between its new values, and those that repeat values for another reason.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_held_streams {
namespace {

using testing::drive;
using testing::find;

/// Positions of a slow receiver in the rows of fast rotations, or a table that was joined by the last value.
TEST(HeldStreams, AHalfThatIsHeldBetweenItsNewValuesIsNamed) {
  for (const bool positions : {true, false})
    for (const Side side : {Side::a, Side::b})
      for (const std::size_t rows : {2u, 3u}) {
        testing::Streams streams = drive(Terrain::rough, 2);
        Trajectory& wrong = side == Side::a ? streams.a : streams.b;
        const Trajectory right = wrong;
        for (std::size_t i = 0; i < wrong.size(); ++i) {
          const Pose now = to_pose(right[i].pose), then = to_pose(right[i - i % rows].pose);
          wrong[i].pose = canonical_sign(to_dual_quaternion(
              positions ? Pose{now.rotation, then.translation} : Pose{then.rotation, now.translation}));
        }
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding* finding = find(calibration, side == Side::a ? "held_a" : "held_b");
        ASSERT_NE(finding, nullptr) << calibration.reason;
        EXPECT_TRUE(finding->certain);
        EXPECT_NE(finding->message.find(positions ? "The positions of" : "The rotations of"),
                  std::string::npos);
        EXPECT_NEAR(finding->value.value_or(0), 10.0 / static_cast<double>(rows), 0.1);
        ASSERT_TRUE(finding->T_a_b);
        const auto off_by = [&](const Pose& T) {
          return extrinsic_error(streams.T, to_dual_quaternion(T)).translation;
        };
        EXPECT_TRUE(calibration.verdict != Verdict::good || off_by(calibration.T_a_b) < 0.6);
        EXPECT_LT(off_by(*finding->T_a_b), 0.3);
      }
}

/// Joined by the last value: 7 Hz into 10 Hz.
TEST(HeldStreams, PositionsThatWereJoinedByTheLastValueAreNamed) {
  testing::Streams streams = drive(Terrain::rough, 2);
  const Trajectory right = streams.b;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const auto then = static_cast<std::size_t>(std::floor(static_cast<double>(i) * 0.7) / 0.7);
    streams.b[i].pose = canonical_sign(
        to_dual_quaternion(Pose{to_pose(right[i].pose).rotation, to_pose(right[then].pose).translation}));
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, "held_b"), nullptr) << calibration.reason;
}

/// The other stream is slower than the held one, begins later, and the drive is long; in coordinates of a
/// map.
TEST(HeldStreams, BesideASlowerStreamInALongDriveAreNamed) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.poses = 12000;
  simulation.rate = 50;
  simulation.relative_noise = 0.005;
  testing::Streams streams = testing::simulated_drive(simulation);
  const Trajectory right = streams.b;
  const Eigen::Vector3d map(445000, 5411000, 120);
  for (std::size_t i = 0; i < right.size(); ++i)
    streams.b[i].pose = canonical_sign(to_dual_quaternion(
        Pose{to_pose(right[i].pose).rotation, map + to_pose(right[i - i % 10].pose).translation}));
  Trajectory slower;
  for (std::size_t i = 13; i < streams.a.size(); i += 7) slower.push_back(streams.a[i]);
  const Calibration calibration = calibrate(slower, streams.b);
  const Finding* finding = find(calibration, "held_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NEAR(finding->value.value_or(0), 5, 0.1);
}

/// On the clock, or at the scale, that is certain the other stream says that the sensor moved on.
TEST(HeldStreams, BesideAWrongScaleOrClockTheyAreNamed) {
  for (const bool positions : {true, false})
    for (const bool clock : {true, false}) {
      testing::Streams streams = drive(Terrain::rough, 2);
      const Trajectory right = streams.b;
      for (std::size_t i = 0; i < right.size(); ++i) {
        const Pose now = to_pose(right[i].pose), then = to_pose(right[i - i % 3].pose);
        const Pose held =
            positions ? Pose{now.rotation, then.translation} : Pose{then.rotation, now.translation};
        streams.b[i].pose = canonical_sign(to_dual_quaternion(held));
      }
      if (clock)
        streams.b = testing::late(streams.b, 3);
      else
        streams.b = testing::lengthened(streams.b, 0.5);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory);
      EXPECT_NE(find(calibration, clock ? "clock_offset" : "scale"), nullptr) << calibration.reason;
      EXPECT_NE(find(calibration, "held_b"), nullptr) << positions << clock << calibration.reason;
    }
}

bool is_held(const Calibration& calibration) {
  return find(calibration, "held_a") != nullptr || find(calibration, "held_b") != nullptr;
}

TEST(HeldStreams, FewDigitsAreNone) {
  const testing::Streams right = drive(Terrain::rough, 2);
  testing::Streams metres = right;
  for (StampedPose& pose : metres.b) {
    Pose rounded = to_pose(pose.pose);
    rounded.translation = rounded.translation.array().round();
    pose.pose = canonical_sign(to_dual_quaternion(rounded));
  }
  EXPECT_FALSE(is_held(calibrate(metres.a, metres.b)));
  // a hundred poses a second, their yaw written to a tenth of a degree
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.poses = 3000;
  simulation.rate = 100;
  simulation.relative_noise = 0.01;
  testing::Streams fast = testing::simulated_drive(simulation);
  constexpr double tenth = 0.1 * std::numbers::pi / 180;
  for (StampedPose& pose : fast.b) {
    const Pose given = to_pose(pose.pose);
    const Eigen::Vector3d turn = rotation_log(given.rotation);
    pose.pose = canonical_sign(to_dual_quaternion(
        Pose{rotation_exp(tenth * (turn / tenth).array().round().matrix()), given.translation}));
  }
  EXPECT_FALSE(is_held(calibrate(fast.a, fast.b)));
}

/// The robot turns on the spot for half of the time: its positions are the same to the last digit.
TEST(HeldStreams, TurningOnTheSpotIsNone) {
  testing::Streams robot;
  Pose at{Rotation::Identity(), Eigen::Vector3d::Zero()};
  testing::Random random(4);
  for (int i = 0; i < 1200; ++i) {
    const bool turns = i / 20 % 2 == 0;
    at = at * Pose{rotation_exp({0, 0, turns ? 0.05 : 0.0}), {turns ? 0.0 : 0.1, 0, 0}};
    const auto time_us = std::int64_t{100'000} * i;
    robot.a.push_back({time_us, to_dual_quaternion(at)});
    robot.b.push_back(
        {time_us, to_dual_quaternion(at * Pose{rotation_exp(random.normal3(1e-3)), {0.5, 0, 0.1}})});
  }
  EXPECT_FALSE(is_held(calibrate(robot.a, robot.b)));
}

/// An arm that takes several orientations in each place, and one that takes each orientation in several
/// places.
TEST(HeldStreams, StationsOfAnArmAreNone) {
  for (const bool places : {true, false}) {
    testing::Random random(5);
    const Pose T{rotation_exp({0.3, -0.2, 1}), {0.1, 0.05, 0.2}};
    testing::Streams arm;
    Pose at;
    for (int i = 0; i < 600; ++i) {
      if (places || i % 5 == 0) at.rotation = rotation_exp(random.normal3(0.3));
      if (!places || i % 5 == 0) at.translation = random.normal3(0.3);
      const auto time_us = std::int64_t{200'000} * i;
      const Pose noise{rotation_exp(random.normal3(1e-3)), random.normal3(1e-3)};
      arm.a.push_back({time_us, canonical_sign(to_dual_quaternion(at))});
      arm.b.push_back({time_us, canonical_sign(to_dual_quaternion(at * T * noise))});
    }
    EXPECT_FALSE(is_held(calibrate(arm.a, arm.b))) << places;
  }
}

}  // namespace
}  // namespace egocal::test_held_streams
