// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry beside a SLAM of flat scans: neither stream measures roll, pitch and height.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_two_dimensions {
namespace {

using testing::find;
using testing::Random;

constexpr double degree = 3.14159265358979323846 / 180;

/// Poses of two sensors of a vehicle on flat ground. Each pose of b, which is mounted with a tilt, is written
/// as x, y and yaw alone; noise_tilt: of roll and pitch [rad].
struct Planar {
  Trajectory a, b;
  double yaw = 0.5, tilt = 5 * degree;
};
Planar planar(std::uint64_t seed, double noise, double noise_tilt) {
  Planar result;
  Random random(seed);
  const Pose mounting{
      Rotation(rotation_exp({0, 0, result.yaw})) * Rotation(rotation_exp({result.tilt, 0, 0})),
      {0.8, 0.3, 0.2}};
  double x = 0, y = 0, heading = 0;
  for (int i = 0; i < 600; ++i) {
    heading += 0.06 * std::sin(0.021 * i) + 0.03 * std::sin(0.13 * i);
    x += 0.1 * std::cos(heading);
    y += 0.1 * std::sin(heading);
    const Pose body{Rotation(rotation_exp({0, 0, heading})), {x, y, 0}};
    const Pose tilted = body * mounting;
    const auto level = [&](const Pose& pose) {
      const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
      const double turned = std::atan2(ahead.y(), ahead.x()) + noise * random.normal();
      return Pose{Rotation(rotation_exp({0, 0, turned})) *
                      Rotation(rotation_exp({noise_tilt * random.normal(), noise_tilt * random.normal(), 0})),
                  {pose.translation.x() + noise * random.normal(),
                   pose.translation.y() + noise * random.normal(), 0}};
    };
    const std::int64_t time = 100'000 * i;
    result.a.push_back({time, to_dual_quaternion(level(body))});
    result.b.push_back({time, to_dual_quaternion(level(tilted))});
  }
  return result;
}

TEST(TwoDimensions, OfBothStreamsLeaveRollAndPitchUnknown) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Planar drive = planar(seed, 0.002, 0);
    const Calibration calibration = calibrate(drive.a, drive.b);
    EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
    const Finding* const found = find(calibration, "flat_both");
    ASSERT_NE(found, nullptr) << seed << " " << calibration.reason;
    EXPECT_TRUE(found->certain);
    EXPECT_NE(found->message.find("roll, pitch"), std::string::npos) << found->message;
    for (const std::size_t i : {2, 3, 4}) {
      EXPECT_FALSE(calibration.observability.observable[i]) << i;
      EXPECT_TRUE(std::isinf(calibration.observability.stddev[i])) << i;
    }
    for (const std::size_t i : {0, 1, 5}) EXPECT_TRUE(calibration.observability.observable[i]) << i;
    EXPECT_NEAR(calibration.T_a_b.translation.x(), 0.8, 0.05);
    EXPECT_NEAR(calibration.T_a_b.translation.y(), 0.3, 0.05);
  }
}

TEST(TwoDimensions, OfTheGroundAreMeasuredByRotationsWithNoise) {
  const Planar drive = planar(4, 0.002, 0.002);
  const Calibration calibration = calibrate(drive.a, drive.b);
  EXPECT_EQ(find(calibration, "flat_both"), nullptr);
  EXPECT_TRUE(calibration.observability.observable[3]);
}

/// Streams without any noise may have three exact angles.
TEST(TwoDimensions, OfStreamsWithoutNoiseAreNoConvention) {
  const Planar drive = planar(5, 0, 0);
  EXPECT_EQ(find(calibrate(drive.a, drive.b), "flat_both"), nullptr);
}

}  // namespace
}  // namespace egocal::test_two_dimensions
