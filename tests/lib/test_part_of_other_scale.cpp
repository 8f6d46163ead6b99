// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A part of a drive in another unit, and the jump that it makes far from the origin.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_part_of_other_scale {
namespace {

using testing::find;

testing::Streams half_a_minute(Terrain terrain, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 601;
  options.relative_noise = 0.01;
  options.seed = seed;
  return testing::simulated_drive(options);
}

/// As written by a program that changed its unit in the middle, with these coordinates of the origin [m].
Trajectory in_feet_from(double part, const Trajectory& right, const Eigen::Vector3d& origin) {
  Trajectory result = right;
  for (std::size_t i = 0; i < right.size(); ++i) {
    Pose pose = to_pose(right[i].pose);
    pose.translation += origin;
    if (static_cast<double>(i) >= part * static_cast<double>(right.size())) pose.translation /= 0.3048;
    result[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  return result;
}

TEST(PartOfOtherScale, IsNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2})
      for (const double part : {0.35, 0.6, 0.8}) {
        const testing::Streams right = half_a_minute(terrain, seed);
        const std::string where = std::to_string(seed) + " " + std::to_string(part);
        const Calibration calibration = calibrate(right.a, in_feet_from(part, right.b, {0, 0, 0}));
        EXPECT_GE(calibration.verdict, Verdict::doubtful) << where << calibration.reason;
        const Finding* finding = find(calibration, "scale_change");
        ASSERT_NE(finding, nullptr) << where << calibration.reason;
        EXPECT_TRUE(finding->certain);
        ASSERT_TRUE(finding->time);
        EXPECT_NEAR(*finding->time, 60 * part, 3) << where << finding->message;
      }
}

/// Far from the origin the change is a jump of thousands of kilometres. As a part of the mean motion, that
/// jump among them, everything agrees.
TEST(PartOfOtherScale, IsNotHiddenByItsOwnJump) {
  for (const std::uint64_t seed : {1, 2}) {
    const testing::Streams right = half_a_minute(Terrain::rough, seed);
    const Calibration calibration = calibrate(right.a, in_feet_from(0.5, right.b, {4.5e5, 5.4e6, 100}));
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
    EXPECT_LT(calibration.fit.length_ratio, 4);
  }
}

/// An origin that is set anew in the middle of a right drive.
TEST(PartOfOtherScale, AJumpAloneChangesNothing) {
  for (const std::uint64_t seed : {1, 2}) {
    const testing::Streams right = half_a_minute(Terrain::rough, seed);
    Trajectory jumps = right.b;
    for (std::size_t i = jumps.size() / 2; i < jumps.size(); ++i) {
      Pose pose = to_pose(jumps[i].pose);
      pose.translation += Eigen::Vector3d(4.5e5, 5.4e6, 100);
      jumps[i].pose = canonical_sign(to_dual_quaternion(pose));
    }
    const Calibration calibration = calibrate(right.a, jumps);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
    EXPECT_NEAR(calibration.fit.length_ratio, 1, 0.02);
    EXPECT_LT(extrinsic_error(right.T, to_dual_quaternion(calibration.T_a_b)).translation, 0.3);
  }
}

}  // namespace
}  // namespace egocal::test_part_of_other_scale
