// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths in another unit or scale and times in another unit or of another clock are named, with their value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "../support/turning_machine.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_units_and_clocks {
namespace {

using testing::drive;
using testing::find;

TEST(UnitsAndClocks, ScaleAndClockComeWithTheirValue) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::lengthened(streams.b, 0.5);
  const Calibration scaled = calibrate(streams.a, streams.b);
  ASSERT_NE(find(scaled, "scale"), nullptr);
  EXPECT_NEAR(*find(scaled, "scale")->value, 2, 0.01);

  testing::Streams late = drive(Terrain::free);
  late.b = testing::late(late.b, 0.3);
  const Calibration shifted = calibrate(late.a, late.b);
  ASSERT_NE(find(shifted, "clock_offset"), nullptr);
  EXPECT_NEAR(*find(shifted, "clock_offset")->value, -0.3, 0.005);
}

TEST(UnitsAndClocks, MillimetresInExchangedColumnsAreNamedBoth) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      testing::Streams streams = drive(terrain, seed);
      for (StampedPose& stamped : streams.b) {
        Pose pose = to_pose(stamped.pose);
        std::swap(pose.translation.x(), pose.translation.y());
        pose.translation *= 1000;
        stamped.pose = to_dual_quaternion(pose);
      }
      const Calibration calibration = calibrate(streams.a, streams.b);
      const Finding *units = find(calibration, "units"), *axes = find(calibration, "axes_b");
      ASSERT_NE(units, nullptr) << seed << ": " << calibration.reason;
      ASSERT_NE(axes, nullptr) << seed << ": " << calibration.reason;
      EXPECT_TRUE(units->certain && axes->certain) << seed;
      EXPECT_EQ(*units->value, 0.001) << seed;
      ASSERT_TRUE(axes->T_a_b);
      EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*axes->T_a_b)).rotation, 0.02) << seed;
    }
}

TEST(UnitsAndClocks, MillimetresMirroredAtTheOriginMayBeThoseOfEitherStream) {
  testing::Streams streams = drive(Terrain::free);
  for (StampedPose& stamped : streams.b) {
    Pose pose = to_pose(stamped.pose);
    pose.translation *= -1000;
    stamped.pose = to_dual_quaternion(pose);
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding *in_a = find(calibration, "axes_a"), *in_b = find(calibration, "axes_b");
  ASSERT_TRUE(in_a && in_b && find(calibration, "units")) << calibration.reason;
  EXPECT_NEAR(in_a->improvement / in_b->improvement, 1, 0.5) << "one is the other mirrored";
}

/// A machine that mostly turns in place shows the scale in few of its motions: the others fit any scale.
TEST(UnitsAndClocks, AWrongScaleIsNamedWhereFewMotionsShowIt) {
  for (const double noise : {0.003, 0.01})
    for (const double scale : {0.67, 0.95, 1.05, 1.3, 1.5})
      for (const std::uint64_t seed : {1, 2}) {
        const testing::Streams streams = testing::turning_machine(seed, scale, noise);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding* finding = find(calibration, "scale");
        ASSERT_NE(finding, nullptr) << scale << ", " << noise << ": " << calibration.reason;
        EXPECT_TRUE(finding->certain);
        EXPECT_NEAR(*finding->value * scale, 1, 0.01);
        EXPECT_NE(finding->remedy.find("--scale-b auto"), std::string::npos);
        EXPECT_GE(calibration.verdict, Verdict::doubtful) << scale << ", " << noise;
        ASSERT_TRUE(finding->T_a_b);
        const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b));
        EXPECT_LT(error.rotation, 0.005);
        EXPECT_LT(error.translation, 0.03);
      }
}

TEST(UnitsAndClocks, ARightScaleIsNotNamedWhereFewMotionsShowIt) {
  for (const double noise : {0.003, 0.01, 0.03})
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      for (const double scale : {1.0, 1.005}) {
        const testing::Streams streams = testing::turning_machine(seed, scale, noise);
        const Calibration calibration = calibrate(streams.a, streams.b);
        EXPECT_EQ(find(calibration, "scale"), nullptr) << scale << ", " << noise << ", " << seed;
        EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
      }
}

TEST(UnitsAndClocks, AClockThatIsOffByMoreThanAQuarterOfTheDriveIsNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double seconds : {25.0, -25.0}) {
      testing::Streams streams = drive(terrain, 3);
      for (StampedPose& stamped : streams.b) stamped.time_us -= std::llround(1e6 * seconds);
      const Calibration calibration = calibrate(streams.a, streams.b);
      const Finding* clock = find(calibration, "clock_offset");
      ASSERT_NE(clock, nullptr) << calibration.reason;
      EXPECT_TRUE(clock->certain);
      EXPECT_NEAR(*clock->value, seconds, 0.01);
    }
}

TEST(UnitsAndClocks, TimesInAnotherUnitAreNamedByAnImpossiblePace) {
  testing::Streams streams = drive(Terrain::free);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "time_unit"), nullptr);
  for (Trajectory* stream : {&streams.a, &streams.b})
    for (StampedPose& pose : *stream) pose.time_us /= 1000;
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, "time_unit");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
  ASSERT_TRUE(finding->value);
  EXPECT_EQ(*finding->value, 1000);
  EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
}

/// Jets are fast, and turn little.
TEST(UnitsAndClocks, AnAircraftIsNoWrongUnitOfTime) {
  const auto streams_at = [](double speed) {
    testing::Streams streams;
    DualQuaternion a, b;
    testing::Random random(1);
    for (int i = 0; i < 1200; ++i) {
      const double t = 0.1 * i;
      const DualQuaternion step =
          testing::displacement(0.1 * Eigen::Vector3d(0.1 * std::sin(0.3 * t), 0.02 * std::sin(0.21 * t),
                                                      0.05 * std::sin(0.11 * t)),
                                {0.1 * speed, 0, 0});
      for (DualQuaternion* pose : {&a, &b})
        *pose = *pose * step * testing::displacement(random.normal3(1e-5), random.normal3(1e-3));
      const auto time_us = static_cast<std::int64_t>(i) * 100'000;
      streams.a.push_back({time_us, canonical_sign(a)});
      streams.b.push_back({time_us, canonical_sign(b)});
    }
    return streams;
  };
  const testing::Streams jet = streams_at(240), in_millimetres = streams_at(8000);
  EXPECT_EQ(find(calibrate(jet.a, jet.b), "time_unit"), nullptr);
  EXPECT_NE(find(calibrate(in_millimetres.a, in_millimetres.b), "time_unit"), nullptr);
}

TEST(UnitsAndClocks, TheRemedyOfAUnitNamesTheStreamThatItIsOf) {
  testing::Streams streams = drive(Terrain::free);
  const Finding* finding = nullptr;
  const Calibration of_b = calibrate(streams.a, testing::lengthened(streams.b, 1000));
  ASSERT_NE(finding = find(of_b, "units"), nullptr);
  EXPECT_EQ(finding->remedy, "--scale-b 0.001");
  const Calibration of_a = calibrate(testing::lengthened(streams.a, 1000), streams.b);
  ASSERT_NE(finding = find(of_a, "units"), nullptr);
  EXPECT_EQ(finding->remedy, "--scale 0.001");
}

/// Kilometres are rare, but a sensor that goes some millimetres a second is as rare: the larger numbers of a
/// were called wrong for certain, and the answer that the cure gave was in kilometres and `good`.
TEST(UnitsAndClocks, AStreamMayAlsoBeInKilometres) {
  const testing::Streams streams = drive(Terrain::free);  // 8 m/s
  const Calibration of_b = calibrate(streams.a, testing::lengthened(streams.b, 0.001));
  const Finding* finding = find(of_b, "units");
  ASSERT_NE(finding, nullptr);
  EXPECT_THAT(finding->message, ::testing::HasSubstr("a or of b are not in metres"));
  EXPECT_THAT(finding->remedy, ::testing::StartsWith("--scale-b 1000, or --scale 0.001"));
  const Calibration of_a = calibrate(testing::lengthened(streams.a, 0.001), streams.b);
  ASSERT_NE(finding = find(of_a, "units"), nullptr);
  EXPECT_THAT(finding->remedy, ::testing::StartsWith("--scale 1000, or --scale-b 0.001"));
}

}  // namespace
}  // namespace egocal::test_units_and_clocks
