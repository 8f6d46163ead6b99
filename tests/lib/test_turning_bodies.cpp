// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bodies without a direction of travel, and bodies that do not travel at all.
#include <gtest/gtest.h>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/turning_bodies.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_turning_bodies {
namespace {

using testing::find;

// Its inverse goes along an arc about the origin: always the same way, as a car does.
TEST(TumblingBody, HasNoDirectionOfTravel) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const double drift : {0.05, 1.0}) {
      testing::Tumbling options;
      options.seed = seed;
      options.drift = drift;
      options.distance = seed % 3 == 0 ? 100 : 10;
      const testing::Streams streams = testing::tumbling(options);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
      for (const Finding& finding : calibration.findings)
        EXPECT_FALSE(finding.certain) << seed << ": " << finding.message;
    }
}

TEST(TumblingBody, IsNoVehicleThatWasReadInversely) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const testing::Streams streams = testing::drive(terrain, seed);
      const Calibration calibration = calibrate(testing::inverted(streams.a), testing::inverted(streams.b));
      const Finding* both = find(calibration, "inverted_both");
      ASSERT_NE(both, nullptr) << seed << ": " << calibration.reason;
      EXPECT_TRUE(both->certain) << seed;
    }
}

// Its positions follow from its rotations: any scale of one stream, and positions mirrored at the origin,
// have a lever arm that fits as well.
TEST(BodyHeldAtAPoint, ShowsNoScaleAndNoMirroredAxes) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const testing::Streams streams = testing::pan_tilt(seed, seed % 2 == 0 ? 0.002 : 0.02);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
    for (const Finding& finding : calibration.findings)
      EXPECT_EQ(finding.code, "inverted_both") << seed << ": " << finding.message;
  }
}

// Its positions must suit its rotations all the same.
TEST(BodyHeldAtAPoint, ShowsColumnsThatAreExchanged) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    testing::Streams streams = testing::pan_tilt(seed, 0.005);
    for (StampedPose& stamped : streams.b) {
      Pose pose = to_pose(stamped.pose);
      std::swap(pose.translation.x(), pose.translation.z());
      stamped.pose = to_dual_quaternion(pose);
    }
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
    const Finding* axes = find(calibration, "axes_b");
    named += axes != nullptr && axes->certain;
  }
  EXPECT_GE(named, 7);
}

// What travels shows its scale.
TEST(TumblingBody, ShowsTheScaleThatItsDriftShows) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    testing::Tumbling options;
    options.seed = seed;
    options.drift = 1;
    testing::Streams streams = testing::tumbling(options);
    Reading longer;
    longer.scale = 1.3;
    streams.b = reread(streams.b, longer);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* scale = find(calibration, "scale");
    ASSERT_NE(scale, nullptr) << seed << ": " << calibration.reason;
    EXPECT_TRUE(scale->certain) << seed;
    EXPECT_NEAR(*scale->value, 1 / 1.3, 0.02) << seed;
  }
}

}  // namespace
}  // namespace egocal::test_turning_bodies
