// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths of one stream that are wrong by no more than right odometries differ by, on a machine where that
// moves the answer by decimetres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_small_scale {
namespace {

using detail::frame_a_difference;
using detail::Vector6d;

constexpr double gravity = 9.81;  // [m/s^2]

/// A multirotor that sways slowly: it tilts as it accelerates, so that lengths that are wrong by e look like
/// a lever arm along its axis, longer by e times gravity over the squared angular frequency.
/// rotations: noise of each step of both sensors [rad].
testing::Streams multirotor(std::uint64_t seed, double scale_of_b, double rotations = 5e-5) {
  testing::Random random(seed);
  const double rate_x = 2 * std::numbers::pi / random.uniform(16, 19),
               rate_y = 2 * std::numbers::pi / random.uniform(14, 16);
  const DualQuaternion mount = to_dual_quaternion(Pose{rotation_exp(random.normal3(0.5)), {0.2, -0.1, 0.1}});
  testing::Streams streams;
  streams.T = mount;
  Pose odometry_a{Rotation::Identity(), Eigen::Vector3d::Zero()}, odometry_b = odometry_a;
  Pose before{Rotation::Identity(), Eigen::Vector3d::Zero()};
  const auto noisy = [&](const Pose& motion, double scale) {
    return Pose{motion.rotation * rotation_exp(random.normal3(rotations)),
                scale * motion.translation + random.normal3(5e-4)};
  };
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.05 * i;
    const Eigen::Vector3d position(9 * std::sin(rate_x * t), 8 * std::sin(rate_y * t + 1),
                                   0.3 * std::sin(0.4 * t));
    const Eigen::Vector2d acceleration(-9 * rate_x * rate_x * std::sin(rate_x * t),
                                       -8 * rate_y * rate_y * std::sin(rate_y * t + 1));
    const Rotation tilt = rotation_exp({-acceleration.y() / gravity, acceleration.x() / gravity, 0});
    const Pose now{tilt * rotation_exp({0, 0, 0.8 * std::sin(0.11 * t)}), position};
    if (i > 0) {
      const Pose motion = inverse(before) * now;
      odometry_a = odometry_a * noisy(motion, 1);
      odometry_b = odometry_b * noisy(inverse(to_pose(mount)) * motion * to_pose(mount), scale_of_b);
    }
    before = now;
    const std::int64_t time_us = static_cast<std::int64_t>(i) * 50'000;
    streams.a.push_back({time_us, to_dual_quaternion(odometry_a)});
    streams.b.push_back({time_us, to_dual_quaternion(odometry_b)});
  }
  return streams;
}

TEST(SmallScale, IsNamedWhereTheAnswerAtItIsAnotherOne) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const testing::Streams streams = multirotor(seed, 1.013);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const ExtrinsicError given = extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b));
    EXPECT_GT(given.translation, 0.6) << seed;
    const Finding* scale = testing::find(calibration, "scale");
    ASSERT_NE(scale, nullptr) << seed << ": " << calibration.reason << " " << given.translation;
    ASSERT_TRUE(scale->T_a_b);
    EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*scale->T_a_b)).translation,
              0.5 * given.translation);
  }
}

/// The largest error in standard deviations.
double sigmas(const testing::Streams& streams, const Calibration& calibration) {
  const Vector6d error = frame_a_difference(streams.T, to_dual_quaternion(calibration.T_a_b));
  double largest = 0;
  for (std::size_t i = 0; i < 6; ++i)
    largest = std::max(largest,
                       std::abs(error[static_cast<Eigen::Index>(i)]) / calibration.observability.stddev[i]);
  return largest;
}

TEST(SmallScale, IsContainedInTheStandardDeviationsWhereItMovesTheAnswer) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const testing::Streams streams = multirotor(seed, 1.006);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* scale = testing::find(calibration, "scale");
    ASSERT_NE(scale, nullptr) << seed << ": " << calibration.reason;
    EXPECT_FALSE(scale->certain);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
    EXPECT_LT(sigmas(streams, calibration), 4) << seed << ": " << scale->message;
    EXPECT_NE(scale->message.find("moves the answer by"), std::string::npos) << scale->message;
    EXPECT_NE(scale->remedy.find("--scale-b auto"), std::string::npos) << scale->remedy;
  }
}

TEST(SmallScale, IsNotNamedWhereLengthsAreRight) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const testing::Streams streams = multirotor(seed, 1);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(testing::find(calibration, "scale"), nullptr) << seed;
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
  }
}

}  // namespace
}  // namespace egocal::test_small_scale
