// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A nominal value of which only a part was measured.
#include <gtest/gtest.h>

#include <limits>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::test_nominal_part {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Pose only(double x, double y, double z) {
  return {Rotation(unknown, unknown, unknown, unknown), {x, y, z}};
}

Calibration completed_by(const Pose& part, const testing::Streams& streams) {
  const Calibration without = calibrate(streams.a, streams.b, {});
  CalibrationOptions options;
  options.pairing.prior = completed_nominal(part, without.problem, to_dual_quaternion(without.T_a_b));
  EXPECT_TRUE(options.pairing.prior.has_value());
  return calibrate(streams.a, streams.b, options);
}

// The height was not taken, or the rest of the pose had to be made up, and contradicted the motions.
TEST(NominalPart, AHeightIsTakenAndNothingElse) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const testing::Streams streams = testing::drive(Terrain::flat, seed);
    const Pose T = inverse(testing::T_vehicle_a) * testing::T_vehicle_b;
    const Calibration calibration = completed_by(only(unknown, unknown, T.translation.z()), streams);
    EXPECT_FALSE(calibration.observability.observable[2]) << "nobody needs it otherwise";
    EXPECT_NEAR(calibration.T_a_b.translation.z(), T.translation.z(), 0.01) << seed;
    EXPECT_EQ(testing::find(calibration, "nominal"), nullptr) << calibration.reason;
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
  }
}

TEST(NominalPart, WhatIsGivenIsJudgedAlone) {
  const testing::Streams streams = testing::drive(Terrain::flat, 1);
  const Pose T = inverse(testing::T_vehicle_a) * testing::T_vehicle_b;
  const Calibration calibration =
      completed_by(only(T.translation.x() + 3, unknown, T.translation.z()), streams);
  const Finding* finding = testing::find(calibration, "nominal");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NE(finding->message.find(" (x) from what the motions show, so z"), std::string::npos)
      << finding->message;
}

TEST(NominalPart, IsOfEitherSensor) {
  const testing::Streams streams = testing::drive(Terrain::flat, 1);
  const Calibration without = calibrate(streams.a, streams.b, {});
  const DualQuaternion answer = to_dual_quaternion(without.T_a_b);
  Pose of_a = inverse(inverse(testing::T_vehicle_a) * testing::T_vehicle_b);
  const DualQuaternion wanted = to_dual_quaternion(inverse(of_a));
  of_a.rotation = Rotation(unknown, unknown, unknown, unknown);
  const std::optional<DualQuaternion> whole =
      completed_nominal(of_a, without.problem, answer, NominalOf::a_in_b);
  ASSERT_TRUE(whole);
  EXPECT_NEAR(to_pose(*whole).translation.z(), to_pose(wanted).translation.z(), 0.02);
}

TEST(NominalPart, ThatIsNotAllThatIsHiddenGivesNothing) {
  const testing::Streams streams = testing::drive(Terrain::flat, 1);
  const Calibration without = calibrate(streams.a, streams.b, {});
  const DualQuaternion answer = to_dual_quaternion(without.T_a_b);
  EXPECT_FALSE(completed_nominal(only(1, 2, unknown), without.problem, answer));
}

TEST(NominalPart, IsNamedByWhatIsKnown) {
  EXPECT_EQ(known_in_words(only(unknown, 1, 2)), "y, z");
  EXPECT_EQ(known_in_words({Rotation::Identity(), {1, unknown, unknown}}), "x, rotation");
  EXPECT_FALSE(is_part(Pose{}));
  EXPECT_EQ(wrong_with_part(only(unknown, unknown, unknown)), "nothing of it is known");
  EXPECT_NE(wrong_with_part({Rotation(1, unknown, 0, 0), {0, 0, 0}}), "");
}

}  // namespace
}  // namespace egocal::test_nominal_part
