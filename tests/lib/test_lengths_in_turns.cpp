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

TEST(LengthsInTurns, OfRightStreamsAreNotNamed) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const testing::Streams right = drive(terrain, seed);
      EXPECT_EQ(find(calibrate(right.a, right.b), "scale_change"), nullptr) << seed;
    }
}

}  // namespace
}  // namespace egocal::test_lengths_in_turns
