// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry beside a SLAM of flat scans: neither stream measures roll, pitch and height.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/findings.hpp"
#include "../support/planar_drive.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_two_dimensions {
namespace {

using testing::find;
using testing::planar_drive;
using testing::PlanarDrive;

TEST(TwoDimensions, OfBothStreamsLeaveRollAndPitchUnknown) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PlanarDrive drive = planar_drive(seed, 0.002, 0);
    const Calibration calibration = calibrate(drive.a, drive.b);
    EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
    const Finding* const found = find(calibration, "flat_both");
    ASSERT_NE(found, nullptr) << seed << " " << calibration.reason;
    EXPECT_TRUE(found->certain);
    EXPECT_NE(found->message.find("roll, pitch"), std::string::npos) << found->message;
    for (const std::size_t i : {2, 3, 4}) {
      EXPECT_FALSE(calibration.observability.observable[i]) << i;
      EXPECT_TRUE(std::isinf(calibration.observability.stddev[i])) << i;
    }
    for (const std::size_t i : {0, 1, 5}) EXPECT_TRUE(calibration.observability.observable[i]) << i;
    EXPECT_NEAR(calibration.T_a_b.translation.x(), 0.8, 0.05);
    EXPECT_NEAR(calibration.T_a_b.translation.y(), 0.3, 0.05);
  }
}

TEST(TwoDimensions, OfTheGroundAreMeasuredByRotationsWithNoise) {
  const PlanarDrive drive = planar_drive(4, 0.002, 0.002);
  const Calibration calibration = calibrate(drive.a, drive.b);
  EXPECT_EQ(find(calibration, "flat_both"), nullptr);
  EXPECT_TRUE(calibration.observability.observable[3]);
}

/// Streams without any noise may have three exact angles.
TEST(TwoDimensions, OfStreamsWithoutNoiseAreNoConvention) {
  const PlanarDrive drive = planar_drive(5, 0, 0);
  EXPECT_EQ(find(calibrate(drive.a, drive.b), "flat_both"), nullptr);
}

}  // namespace
}  // namespace egocal::test_two_dimensions
