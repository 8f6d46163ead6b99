// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams whose positions and rotations are of different times: a filter delays one of them, or rows are off
// by one.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_late_parts {
namespace {

using testing::bounded_drive;
using testing::find;

/// Late positions of one stream are early ones of the other. Rows that are off by one show which it is where
/// noise is small; else both are named, the late one first, and that one of them is wrong is certain.
void expect_late(const Calibration& calibration, const std::string& late, const std::string& early,
                 double delay) {
  std::vector<std::string> codes;
  bool certain = false;
  for (const Finding& finding : calibration.findings) {
    if (!finding.code.starts_with("late_positions_")) continue;
    codes.push_back(finding.code);
    certain = certain || finding.certain;
    EXPECT_EQ(finding.message.find(", or those of ") == std::string::npos, finding.certain)
        << finding.message;
    ASSERT_TRUE(finding.value && finding.T_a_b);
    EXPECT_NEAR(*finding.value, finding.code == late ? delay : -delay, 0.05);
  }
  const std::vector<std::string> both{late, early};
  EXPECT_EQ(codes, certain ? std::vector<std::string>{late} : both) << calibration.reason;
}

/// A filter that is late by 0.3 s, of the positions alone. Turns that are quick and a long lever arm show in
/// which stream.
TEST(LateParts, PositionsThatAreLaterThanTheRotationsAreNamed) {
  for (const Side side : {Side::a, Side::b}) {
    testing::Streams streams = bounded_drive();
    EXPECT_EQ(find(calibrate(streams.a, streams.b), "late_positions_b"), nullptr);
    Trajectory& wrong = side == Side::a ? streams.a : streams.b;
    wrong = testing::with_late_positions(wrong, 3);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
    const bool of_a = side == Side::a;
    const Finding* finding = find(calibration, of_a ? "late_positions_a" : "late_positions_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_TRUE(finding->certain);
    EXPECT_EQ(find(calibration, of_a ? "late_positions_b" : "late_positions_a"), nullptr);
    ASSERT_TRUE(finding->value && finding->T_a_b);
    EXPECT_NEAR(*finding->value, 0.3, 0.05);
    const auto off_by = [&](const Pose& T) {
      return extrinsic_error(streams.T, to_dual_quaternion(T)).translation;
    };
    EXPECT_LT(off_by(finding->T_a_b.value()), 0.5 * off_by(calibration.T_a_b));
  }
}

/// Rows off by one on a road: the verdict is as if one stream were named.
TEST(LateParts, OnARoadEitherStreamMayHaveTheLatePositions) {
  for (const double noise : {0.001, 0.01})
    for (const Side side : {Side::a, Side::b}) {
      SimulationOptions simulation;
      simulation.terrain = Terrain::rough;
      simulation.poses = 601;
      simulation.relative_noise = noise;
      simulation.speed_variation = 0.3;
      simulation.seed = 7;
      testing::Streams streams = testing::simulated_drive(simulation);
      Trajectory& wrong = side == Side::a ? streams.a : streams.b;
      wrong = testing::with_late_positions(wrong, 1);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
      if (side == Side::a)
        expect_late(calibration, "late_positions_a", "late_positions_b", 0.1);
      else
        expect_late(calibration, "late_positions_b", "late_positions_a", 0.1);
    }
}

/// A filter that delays the rotations alone looks like a clock that is off, and at that clock the positions
/// are early.
TEST(LateParts, RotationsThatAreLaterThanThePositionsAreNamed) {
  testing::Streams streams = bounded_drive();
  constexpr std::size_t late = 3;  // poses, of 10 a second
  for (std::size_t i = streams.b.size() - 1; i >= late; --i) {
    Pose pose = to_pose(streams.b[i].pose);
    pose.rotation = to_pose(streams.b[i - late].pose).rotation;
    streams.b[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(calibration.verdict, Verdict::good) << calibration.reason;
  const Finding *clock = find(calibration, "clock_offset"),
                *positions = find(calibration, "late_positions_b");
  ASSERT_NE(clock, nullptr) << calibration.reason;
  ASSERT_NE(positions, nullptr) << calibration.reason;
  EXPECT_NEAR(*clock->value, -0.3, 0.1);
  EXPECT_NEAR(*positions->value, -0.3, 0.1);
  ASSERT_TRUE(positions->T_a_b);
  EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*positions->T_a_b)).rotation, 0.01);
}

/// An offset that is estimated from rotations and positions of different times lies between both: such
/// answers were good and 60 cm off, with the cure that was printed without it.
TEST(LateParts, RotationsThatAreLaterThanThePositionsAreNamedBesideAnEstimatedOffset) {
  testing::Streams streams = bounded_drive();
  for (std::size_t i = streams.b.size() - 1; i >= 1; --i) {
    Pose pose = to_pose(streams.b[i].pose);
    pose.rotation = to_pose(streams.b[i - 1].pose).rotation;
    streams.b[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  CalibrationOptions options;
  options.estimate_time_offset = true;
  const Calibration calibration = calibrate(streams.a, streams.b, options);
  EXPECT_NE(calibration.verdict, Verdict::good) << calibration.reason;
  const Finding* finding = find(calibration, "late_positions_b");
  if (!finding) finding = find(calibration, "late_positions_a");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NEAR(std::abs(*finding->value), 0.1, 0.03);
  ASSERT_TRUE(finding->T_a_b);
  EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.01);
}

}  // namespace
}  // namespace egocal::test_late_parts
