// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One pose at a time: the options count as in calibrate(), and nothing is claimed that needs the whole drive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/scale/scale_statistics.hpp"

namespace egocal::test_calibrator {
namespace {

testing::Streams rough_drive() {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = 401;
  options.relative_noise = 0.01;
  options.seed = 5;
  return testing::simulated_drive(options);
}

Calibration one_pose_at_a_time(const testing::Streams& s, const CalibrationOptions& options) {
  Calibrator calibrator(options);
  for (std::size_t i = 0; i < std::max(s.a.size(), s.b.size()); ++i) {
    if (i < s.a.size()) calibrator.add(Side::a, s.a[i]);
    if (i < s.b.size()) calibrator.add(Side::b, s.b[i]);
  }
  calibrator.finish();
  return calibrator.answer().value();
}

void expect_same_bits(const Calibration& x, const Calibration& y) {
  EXPECT_EQ(x.T_a_b.translation, y.T_a_b.translation);
  EXPECT_EQ(x.T_a_b.rotation.coeffs(), y.T_a_b.rotation.coeffs());
  EXPECT_EQ(x.scale_applied, y.scale_applied);
}

TEST(Calibrator, ReadsThePosesAsCalibrateDoes) {
  testing::Streams s = rough_drive();
  CalibrationOptions options;
  expect_same_bits(one_pose_at_a_time(s, options), calibrate(s.a, s.b, options));
  options.read_b.invert = true;
  for (StampedPose& pose : s.b) pose.pose = conjugate(pose.pose);
  options.read_a.scale = 0.5;
  s.a = scaled(s.a, 2);
  expect_same_bits(one_pose_at_a_time(s, options), calibrate(s.a, s.b, options));
  options.scale = 0.25;
  options.scale_side = Side::b;
  s.b = scaled(s.b, 4);
  expect_same_bits(one_pose_at_a_time(s, options), calibrate(s.a, s.b, options));
}

TEST(Calibrator, RefusesToEstimateAScale) {
  CalibrationOptions options;
  options.estimate_scale = true;
  EXPECT_THROW(
      try { Calibrator calibrator(options); } catch (const Error& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("estimate_scale"));
        throw;
      },
      Error);
}

/// Half of the drive contradicts the other one; without the poses that cannot be seen.
TEST(Calibrator, CallsNothingGoodThatItDidNotLookAt) {
  testing::Streams s = rough_drive();
  EXPECT_EQ(calibrate(s.a, s.b).verdict, Verdict::good);
  EXPECT_EQ(one_pose_at_a_time(s, {}).verdict, Verdict::incomplete);
  EXPECT_THAT(one_pose_at_a_time(s, {}).reason, ::testing::HasSubstr("whether the motions agree"));
  CalibrationOptions unjudged;
  unjudged.diagnosis.enabled = false;
  EXPECT_EQ(calibrate(s.a, s.b, unjudged).verdict, Verdict::incomplete);

  const DualQuaternion knock = to_dual_quaternion({rotation_exp({0, 0, 0.035}), Eigen::Vector3d::Zero()});
  for (std::size_t i = s.b.size() / 2; i < s.b.size(); ++i) s.b[i].pose = s.b[i].pose * knock;
  EXPECT_EQ(calibrate(s.a, s.b).verdict, Verdict::contradictory);
  EXPECT_EQ(one_pose_at_a_time(s, {}).verdict, Verdict::incomplete);
}

}  // namespace
}  // namespace egocal::test_calibrator
