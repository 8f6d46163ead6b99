// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Verdicts on lengths that are not known to be metres, and lengths in words.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal::test_verdict_units {
namespace {

using testing::drive;
using testing::find;
using testing::lengthened;

/// Two models without scale may be in any unit. In a unit of 10 m an error of 6 m must not count as 60 cm,
/// and in a unit of 1 mm no motion may be impossibly fast.
TEST(VerdictUnits, WithoutMetresAnswersAreJudgedAlikeInEveryUnit) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free, Terrain::flat}) {
    const testing::Streams right = drive(terrain);
    CalibrationOptions options;
    options.diagnosis.unit = LengthUnit::unknown;
    const Calibration one = calibrate(right.a, right.b, options);
    for (const double factor : {0.02, 1000.0}) {
      const Calibration other = calibrate(lengthened(right.a, factor), lengthened(right.b, factor), options);
      EXPECT_EQ(other.verdict, one.verdict) << factor << ": " << other.reason << "\n" << one.reason;
      EXPECT_EQ(find(other, "time_unit"), nullptr) << factor;
      EXPECT_EQ(other.reason.find("cm"), std::string::npos) << other.reason;
    }
  }
}

/// A height that is known to a metre of a road is not good in units of 10 m.
TEST(VerdictUnits, WithoutMetresALongUnitDoesNotMakeTheAnswerGood) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.poses = 201;
  simulation.relative_noise = 0.03;
  const testing::Streams right = testing::simulated_drive(simulation);
  CalibrationOptions options;
  const Calibration in_metres = calibrate(right.a, right.b, options);
  ASSERT_EQ(in_metres.verdict, Verdict::incomplete) << in_metres.reason;
  const Trajectory a = lengthened(right.a, 0.02), b = lengthened(right.b, 0.02);
  EXPECT_NE(calibrate(a, b, options).verdict, Verdict::incomplete);  // as if they were metres
  options.diagnosis.unit = LengthUnit::unknown;
  const Calibration unknown = calibrate(a, b, options);
  EXPECT_EQ(unknown.verdict, Verdict::incomplete) << unknown.reason;
  EXPECT_NE(unknown.reason.find("units"), std::string::npos) << unknown.reason;
}

/// Nor of streams of one frame, nor of a copy that was rounded.
TEST(VerdictUnits, WithoutMetresOneFrameAndARoundedCopyAreSaidInUnits) {
  const testing::Streams streams = drive(Terrain::free);
  CalibrationOptions options;
  options.diagnosis.unit = LengthUnit::unknown;
  const Pose T{rotation_exp({0.3, -0.4, 1}), {0.5, 0.2, -0.1}};
  Trajectory rounded = testing::seen_from(streams.a, to_dual_quaternion(T));
  for (StampedPose& pose : rounded) {
    Pose here = to_pose(pose.pose);
    here.translation = (1e3 * here.translation).array().round() / 1e3;
    here.rotation.coeffs() = (1e5 * here.rotation.coeffs()).array().round() / 1e5;
    here.rotation.normalize();
    pose.pose = canonical_sign(to_dual_quaternion(here));
  }
  for (const Trajectory& b : {testing::seen_from(streams.b, streams.T), rounded}) {
    const Calibration calibration = calibrate(streams.a, b, options);
    const Finding* finding = find(calibration, "same_stream");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_NE(finding->message.find(" units"), std::string::npos) << finding->message;
  }
}

/// No finding says metres either: not of a mount that moved far, moved little, or goes back and forth.
TEST(VerdictUnits, WithoutMetresAMovedMountIsSaidInUnits) {
  const auto said = [](const Pose& moved, bool back_and_forth, LengthUnit unit) {
    testing::Streams streams = drive(Terrain::free);
    const std::int64_t begin_us = streams.b.front().time_us,
                       middle_us = streams.b[streams.b.size() / 2].time_us;
    for (StampedPose& pose : streams.b) {
      const bool there =
          back_and_forth ? (pose.time_us - begin_us) / 7'000'000 % 2 == 1 : pose.time_us > middle_us;
      if (there) pose.pose = canonical_sign(normalized(pose.pose * to_dual_quaternion(moved)));
    }
    CalibrationOptions options;
    options.diagnosis.unit = unit;
    const Calibration calibration = calibrate(streams.a, streams.b, options);
    const Finding* finding = find(calibration, "mount_moved");
    return finding == nullptr ? calibration.reason : finding->message + finding->remedy;
  };
  const Pose far{Eigen::Quaterniond::Identity(), {0, 3, 0}}, little{rotation_exp({0, 0.06, 0}), {0, 0.1, 0}},
      loose{rotation_exp({0.03, 0.05, 0}), {0, 0.05, 0}};
  for (const auto& [moved, back_and_forth] : {std::pair(far, false), {little, false}, {loose, true}}) {
    const std::string in_metres = said(moved, back_and_forth, LengthUnit::metres);
    EXPECT_TRUE(in_metres.find(" cm") != std::string::npos || in_metres.find(" m") != std::string::npos)
        << in_metres;
    const std::string unknown = said(moved, back_and_forth, LengthUnit::unknown);
    EXPECT_NE(unknown.find(" units"), std::string::npos) << unknown;
    EXPECT_EQ(unknown.find(" cm"), std::string::npos) << unknown;
  }
}

TEST(VerdictUnits, AScaleNearOneSaysThatBothMeasureMetres) {
  EXPECT_EQ(unit_of_scaled(LengthUnit::metres_where_alike, 1.05), LengthUnit::metres);
  EXPECT_EQ(unit_of_scaled(LengthUnit::metres_where_alike, 0.95), LengthUnit::metres);
  EXPECT_EQ(unit_of_scaled(LengthUnit::metres_where_alike, 0.37), LengthUnit::unknown);
  EXPECT_EQ(unit_of_scaled(LengthUnit::metres, 0.37), LengthUnit::metres);
  EXPECT_EQ(unit_of_scaled(LengthUnit::unknown, 1), LengthUnit::unknown);
  const testing::Streams right = drive(Terrain::flat);
  CalibrationOptions options;
  options.estimate_scale = true;
  options.diagnosis.unit = LengthUnit::metres_where_alike;
  const Calibration near = calibrate(right.a, right.b, options);
  EXPECT_NE(near.reason.find("60 cm"), std::string::npos) << near.reason;
  const Calibration far = calibrate(lengthened(right.a, 0.37), right.b, options);
  EXPECT_EQ(far.reason.find("60 cm"), std::string::npos) << far.reason;
  EXPECT_NE(far.reason.find("units"), std::string::npos) << far.reason;
}

/// "%.3g" of 999.5 cm and more would be "1e+03 cm".
TEST(VerdictUnits, LengthsAreWrittenWithoutPowersOfTen) {
  using detail::length_in_words;
  EXPECT_EQ(length_in_words(0.6), "60 cm");
  EXPECT_EQ(length_in_words(0.678), "67.8 cm");
  EXPECT_EQ(length_in_words(9.99), "999 cm");
  EXPECT_EQ(length_in_words(9.996), "10 m");
  EXPECT_EQ(length_in_words(9.9999), "10 m");
  EXPECT_EQ(length_in_words(123.4), "123 m");
  EXPECT_EQ(length_in_words(999.6), "1000 m");
  EXPECT_EQ(length_in_words(12345), "12345 m");
  EXPECT_EQ(length_in_words(1.234, false), "1.23 units");
  EXPECT_EQ(length_in_words(999.4, false), "999 units");
  EXPECT_EQ(length_in_words(999.6, false), "1000 units");
}

}  // namespace
}  // namespace egocal::test_verdict_units
