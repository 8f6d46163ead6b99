// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Verdicts on lengths that are not known to be metres, and lengths in words.
#include <gtest/gtest.h>

#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "diagnosis/wording.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_verdict_units {
namespace {

using testing::drive;
using testing::find;
using testing::lengthened;

/// Two models without scale may be in any unit: neither may that of 10 m make 60 cm of 6 m, nor that of 1 mm
/// a motion that is impossibly fast.
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
}

}  // namespace
}  // namespace egocal::test_verdict_units
