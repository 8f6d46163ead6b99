// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// An odometry that loses length while it turns: one factor for the whole drive leaves a wrong answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "../support/findings.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/scale/estimate_scale.hpp"

namespace egocal::test_lengths_in_turns {
namespace {

using testing::drive;
using testing::find;

/// The steps of b are too short by up to this part, in proportion to their turning.
Trajectory slipping(const Trajectory& right, double most) {
  std::vector<Pose> steps;
  std::vector<double> angles;
  for (std::size_t i = 1; i < right.size(); ++i) {
    steps.push_back(inverse(to_pose(right[i - 1].pose)) * to_pose(right[i].pose));
    angles.push_back(rotation_log(steps.back().rotation).norm());
  }
  std::vector<double> sorted = angles;
  std::sort(sorted.begin(), sorted.end());
  const double fastest = sorted[sorted.size() * 95 / 100];
  Trajectory wrong = right;
  Pose at = to_pose(right.front().pose);
  for (std::size_t i = 1; i < right.size(); ++i) {
    Pose step = steps[i - 1];
    step.translation *= 1 - most * std::min(1.0, angles[i - 1] / fastest);
    at = at * step;
    wrong[i].pose = to_dual_quaternion(at);
  }
  return wrong;
}

/// The vertical of the vehicle, in the frame of b.
Eigen::Vector3d T_vehicle_b_up() {
  return testing::T_vehicle_b.rotation.conjugate() * Eigen::Vector3d::UnitZ();
}

/// The steps of b are too long in turns to one side, and too short in those to the other: by this part at
/// the fastest turns, or by the side alone.
Trajectory with_lengths_of_a_side(const Trajectory& right, double part, bool side_alone) {
  const Eigen::Vector3d up = T_vehicle_b_up();
  std::vector<Pose> steps;
  std::vector<double> angles, sorted;
  for (std::size_t i = 1; i < right.size(); ++i) {
    steps.push_back(inverse(to_pose(right[i - 1].pose)) * to_pose(right[i].pose));
    angles.push_back(up.dot(rotation_log(steps.back().rotation)));
    sorted.push_back(std::abs(angles.back()));
  }
  std::sort(sorted.begin(), sorted.end());
  const double fastest = side_alone ? 0 : sorted[sorted.size() * 95 / 100];
  Trajectory wrong = right;
  Pose at = to_pose(right.front().pose);
  for (std::size_t i = 1; i < right.size(); ++i) {
    Pose step = steps[i - 1];
    const double turning = angles[i - 1] / std::max(fastest, std::abs(angles[i - 1]));
    step.translation *= 1 + part * turning;
    at = at * step;
    wrong[i].pose = to_dual_quaternion(at);
  }
  return wrong;
}

/// After the cure of the scale that fits best the motions agree, with a wrong answer.
TEST(LengthsInTurns, AreNamedAtTheBestScale) {
  SimulationOptions options;
  options.poses = 1201;
  options.relative_noise = 0.01;
  for (const std::uint64_t seed : {1, 2}) {
    options.seed = seed;
    testing::Streams wrong = testing::simulated_drive(options);
    wrong.b = slipping(wrong.b, 0.15);
    DriveScaleOptions of_b;
    of_b.scale.side = Side::b;
    const std::optional<ScaleSolution> scale = estimate_scale(wrong.a, wrong.b, {}, of_b);
    ASSERT_TRUE(scale) << seed;
    for (StampedPose& pose : wrong.b) pose.pose.dual *= scale->scale;
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << " " << calibration.reason;
    const Finding* const found = find(calibration, "scale_change");
    ASSERT_NE(found, nullptr) << seed << " " << calibration.reason;
    EXPECT_NE(found->message.find("too short while it turns"), std::string::npos) << found->message;
  }
}

/// At a constant speed they are a lever arm; where it changes they are none.
TEST(LengthsInTurns, ToASideAreNamedWhereTheSpeedChanges) {
  SimulationOptions options;
  options.poses = 1201;
  options.relative_noise = 0.005;
  options.speed_variation = 0.4;
  for (const bool side_alone : {false, true})
    for (const std::uint64_t seed : {1, 3}) {
      options.seed = seed;
      testing::Streams wrong = testing::simulated_drive(options);
      wrong.b = with_lengths_of_a_side(wrong.b, 0.05, side_alone);
      const Calibration calibration = calibrate(wrong.a, wrong.b);
      EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << " " << calibration.reason;
      const Finding* const found = find(calibration, "scale_change");
      ASSERT_NE(found, nullptr) << side_alone << " " << seed << " " << calibration.reason;
      EXPECT_NE(found->message.find("in turns to one side"), std::string::npos) << found->message;
      ASSERT_TRUE(found->T_a_b);
      const ExtrinsicError error = extrinsic_error(wrong.T, to_dual_quaternion(*found->T_a_b));
      EXPECT_LT(error.translation, 0.4) << side_alone << " " << seed << " " << found->message;
    }
}

TEST(LengthsInTurns, OfRightStreamsAreNotNamed) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const testing::Streams right = drive(terrain, seed);
      EXPECT_EQ(find(calibrate(right.a, right.b), "scale_change"), nullptr) << seed;
    }
}

}  // namespace
}  // namespace egocal::test_lengths_in_turns
