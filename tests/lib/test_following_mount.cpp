// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mounts that follow what the vehicle does, and parts of a drive that contradict the others.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "diagnosis/mount/following_mount.hpp"
#include "diagnosis/streams/contradicting_parts.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_following_mount {
namespace {

using testing::find;

/// b on a part that turns about its x axis with the turning rate, by up to `most` [rad]; half of it where the
/// rate is about half of 1 / gain [rad/s].
Trajectory steered(const Trajectory& poses, double most, double gain) {
  Trajectory result = poses;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double seconds = 1e-6 * static_cast<double>(poses[i + 1].time_us - poses[i - 1].time_us);
    const double rate =
        rotation_log(to_pose(conjugate(poses[i - 1].pose) * poses[i + 1].pose).rotation).x() / seconds;
    result[i].pose =
        normalized(poses[i].pose * testing::displacement({most * std::tanh(gain * rate), 0, 0}, {0, 0, 0}));
  }
  return result;
}

detail::Following follows(const testing::Streams& streams) {
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  return detail::following(instants, streams.T, 8).value_or(detail::Following{});
}

TEST(FollowingMount, IsToldFromNoise) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    testing::Streams streams = testing::drive(Terrain::free, seed);
    EXPECT_LT(follows(streams).explained, 0.1);
    streams.b = steered(streams.b, 0.09, 2);
    EXPECT_GT(follows(streams).explained, 0.5);
    EXPECT_GT(follows(streams).change, 0.02);
  }
}

TEST(FollowingMount, IsNotAClockThatDiffers) {
  testing::Streams streams = testing::drive(Terrain::free);
  for (StampedPose& pose : streams.b) pose.time_us += 50'000;
  EXPECT_LT(follows(streams).explained, 0.3);
}

TEST(FollowingMount, IsDoubtful) {
  testing::Streams streams = testing::bounded_drive();
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "mount_moved"), nullptr);
  streams.b = steered(streams.b, 0.03, 2);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
  const Finding* finding = find(calibration, "mount_moved");
  ASSERT_NE(finding, nullptr);
  EXPECT_FALSE(finding->certain);
  EXPECT_NE(finding->message.find("turn and accelerate"), std::string::npos) << finding->message;
}

TEST(ContradictingParts, AreTheTenthsThatFitTensOfTimesWorse) {
  testing::Streams streams = testing::noisy_drive(Terrain::free, 0.001);
  const auto found = [&] {
    return detail::contradicting_parts(detail::synchronised(streams.a, streams.b, {}, 0.5), 8,
                                       to_pose(streams.T), {});
  };
  EXPECT_TRUE(found().parts.empty());
  for (std::size_t i = 0; i < 120; ++i)
    streams.b[i].pose = normalized(streams.b[i].pose * testing::displacement({0, 0.2, 0}, {0, 0, 0}));
  ASSERT_EQ(found().parts.size(), 2u);
  EXPECT_NEAR(found().parts[1].end, 12, 0.5);
  const std::optional<Finding> finding = detail::contradicting_parts_finding(found());
  ASSERT_TRUE(finding);
  EXPECT_FALSE(finding->certain);
  EXPECT_NE(finding->message.find("contradict each other"), std::string::npos) << finding->message;
}

TEST(ContradictingParts, AreNotASingleJump) {
  testing::Streams streams = testing::noisy_drive(Terrain::free, 0.001);
  const DualQuaternion jump = to_dual_quaternion(Pose{rotation_exp({0.1, 0.1, 0.1}), {0.5, 0, 0}});
  for (std::size_t i = 90; i < streams.b.size(); ++i)
    streams.b[i].pose = normalized(jump * streams.b[i].pose);
  EXPECT_TRUE(detail::contradicting_parts(detail::synchronised(streams.a, streams.b, {}, 0.5), 40,
                                          to_pose(streams.T), {})
                  .parts.empty());
}

// Of a vehicle that stands only motions to and from wrong poses are motions.
TEST(ContradictingParts, AreNotWrongPosesOfAVehicleThatStands) {
  testing::Streams streams = testing::noisy_drive(Terrain::free, 0.001);
  testing::Random random(7);
  for (std::size_t i = 120; i < 260; ++i) {
    for (Trajectory* stream : {&streams.a, &streams.b})
      (*stream)[i].pose = normalized((*stream)[119].pose * testing::normal_displacement(random, 1e-4, 1e-4));
    if (i % 5 == 0)
      streams.b[i].pose = normalized(streams.b[i].pose * testing::displacement({0, 0.2, 0}, {0, 0, 0}));
  }
  EXPECT_TRUE(detail::contradicting_parts(detail::synchronised(streams.a, streams.b, {}, 0.5), 8,
                                          to_pose(streams.T), {})
                  .parts.empty());
}

// Of 61 poses each tenth has six motions, and two wrong poses spoil four of them.
TEST(ContradictingParts, AreNotTwoWrongPosesOfAShortDrive) {
  testing::Streams streams = testing::noisy_drive(Terrain::free, 0.001);
  streams.a.resize(61);
  streams.b.resize(61);
  for (const std::size_t i : {20u, 22u})
    streams.b[i].pose = normalized(streams.b[i].pose * testing::displacement({0, 0.2, 0}, {0, 0, 0}));
  EXPECT_TRUE(detail::contradicting_parts(detail::synchronised(streams.a, streams.b, {}, 0.5), 1,
                                          to_pose(streams.T), {})
                  .parts.empty());
}

}  // namespace
}  // namespace egocal::test_following_mount
