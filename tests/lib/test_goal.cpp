// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How far a drive is from its goal, and what to drive next.
#include <gtest/gtest.h>

#include <numbers>

#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"

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

TEST(Goal, ThePlatformChoosesTheWords) {
  const Calibration calibration = after(301, Terrain::flat, {0.1 * degree, 0.01, Platform::arm});
  ASSERT_TRUE(calibration.goal);
  EXPECT_NE(calibration.goal->next.find("hand"), std::string::npos) << calibration.goal->next;
}

}  // namespace
}  // namespace egocal::test_goal
