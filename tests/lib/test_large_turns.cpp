// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mounts that seem to turn by a lot: streams that are exchanged, and a turn that looks like another reading.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_large_turns {
namespace {

using testing::drive;
using testing::find;

TEST(ExchangedStreams, AreNamed) {
  for (const std::uint64_t seed : {1, 2}) {
    testing::Streams wrong = drive(Terrain::free, seed);
    for (std::size_t i = wrong.a.size() * 2 / 5; i < wrong.a.size(); ++i)
      std::swap(wrong.a[i].pose, wrong.b[i].pose);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << " " << calibration.reason;
    const Finding* const moved = find(calibration, "mount_moved");
    ASSERT_NE(moved, nullptr) << seed << " " << calibration.reason;
    EXPECT_NE(moved->message.find("are exchanged from then on"), std::string::npos) << moved->message;
    ASSERT_TRUE(moved->time);
    EXPECT_NEAR(*moved->time, 24, 1) << seed;
  }
}

/// Half a turn about the vertical makes yaw 90 of it yaw -90, which is its inverse, at another place.
TEST(ExchangedStreams, AreNotNamedWhereASensorThatLooksAsideWasTurnedRound) {
  const Pose aside{rotation_exp({0, 0, 1.5707963}), {0.5, 0, 0.2}},
      round{rotation_exp({0, 0, 3.1415926}), {0, 0, 0}};
  for (const Terrain terrain : {Terrain::flat, Terrain::rough})
    for (const std::uint64_t seed : {1, 2}) {
      testing::Streams wrong = drive(terrain, seed);
      const DualQuaternion other = conjugate(wrong.T) * to_dual_quaternion(aside);
      for (StampedPose& stamped : wrong.b) stamped.pose = canonical_sign(normalized(stamped.pose * other));
      wrong.b = testing::knocked(wrong.b, 0.5, round);
      for (const Finding& finding : calibrate(wrong.a, wrong.b).findings)
        EXPECT_EQ(finding.message.find("exchanged"), std::string::npos) << seed << " " << finding.message;
    }
}

TEST(ExchangedStreams, AreNotNamedWhereASensorWasTurnedRound) {
  const Pose round{rotation_exp({0, 0, 3}), {0.3, 0, 0}};
  for (const std::uint64_t seed : {1, 2}) {
    testing::Streams wrong = drive(Terrain::rough, seed);
    wrong.b = testing::knocked(wrong.b, 0.5, round);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    const Finding* const moved = find(calibration, "mount_moved");
    ASSERT_NE(moved, nullptr) << seed << " " << calibration.reason;
    EXPECT_EQ(moved->message.find("exchanged"), std::string::npos) << moved->message;
  }
}

/// Half-way in a long drive that looked like a quaternion in another order.
TEST(TurnedMount, IsNotAnotherQuaternionOrder) {
  SimulationOptions options;
  options.poses = 2001;
  options.rate = 1;
  options.roughness = 0.02;
  options.relative_noise = 0.01;
  const Pose aside{rotation_exp({0, 0, 0.7}), Eigen::Vector3d::Zero()};
  for (const std::uint64_t seed : {1, 2}) {
    options.seed = seed;
    testing::Streams wrong = testing::simulated_drive(options);
    wrong.b = testing::knocked(wrong.b, 0.5, aside);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << " " << calibration.reason;
    testing::certain_finding(calibration, "mount_moved");
    EXPECT_EQ(find(calibration, "quaternion_order_b"), nullptr) << seed;
  }
}

}  // namespace
}  // namespace egocal::test_large_turns
