// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Two odometries in one stream: each has an origin of its own, and each goes on.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_two_senders {
namespace {

using testing::with_another_sender;

const Finding* mixed(const Calibration& calibration) {
  const Finding* of_a = testing::find(calibration, "mixed_frames_a");
  return of_a ? of_a : testing::find(calibration, "mixed_frames_b");
}

testing::Streams handheld(std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.rate = 30;
  options.poses = 901;
  options.relative_noise = 0.01;
  options.seed = seed;
  return testing::simulated_drive(options);
}

/// Answers were incomplete, 76 deg off and that by 110 standard deviations, or the clock was blamed.
TEST(TwoSenders, AreNamedWithTheirStream) {
  for (const std::uint64_t seed : {1, 2})
    for (const std::size_t every : {1, 3})
      for (const char side : {'a', 'b'}) {
        testing::Streams streams = handheld(seed);
        Trajectory& wrong = side == 'a' ? streams.a : streams.b;
        wrong = with_another_sender(wrong, every);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding* finding = testing::find(calibration, std::string("mixed_frames_") + side);
        ASSERT_NE(finding, nullptr) << side << every << calibration.reason;
        EXPECT_TRUE(finding->certain);
        EXPECT_NE(finding->message.find("two odometries"), std::string::npos) << finding->message;
        EXPECT_EQ(calibration.verdict, Verdict::contradictory);
        EXPECT_EQ(testing::find(calibration, "clock_offset"), nullptr);
      }
}

/// Two frames of one body by turns look like two odometries, too, and are named once, as what they are.
TEST(TwoSenders, TwoFramesOfOneBodyAreNamedOnce) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.rate = 20;
  options.speed = 1;
  options.poses = 901;
  options.relative_noise = 0.01;
  testing::Streams streams = testing::simulated_drive(options);
  const DualQuaternion other = to_dual_quaternion(Pose{rotation_exp({0, 0, 0.3}), {0.6, 0, 0.1}});
  for (std::size_t i = 1; i < streams.b.size(); i += 2)
    streams.b[i].pose = canonical_sign(normalized(streams.b[i].pose * other));
  const Calibration calibration = calibrate(streams.a, streams.b);
  std::size_t named = 0;
  for (const Finding& finding : calibration.findings) {
    if (finding.code != "mixed_frames_b") continue;
    ++named;
    EXPECT_EQ(finding.message.find("two odometries"), std::string::npos) << finding.message;
  }
  EXPECT_EQ(named, 1U) << calibration.reason;
}

/// Positions that are wrong by chance do not go on.
TEST(TwoSenders, WrongPosesAreNoOtherSender) {
  testing::Streams streams = handheld(3);
  testing::Random random(7);
  for (std::size_t i = 3; i < streams.b.size(); i += 5)
    streams.b[i].pose = canonical_sign(to_dual_quaternion(Pose{Rotation::Identity(), random.normal3(20)}));
  EXPECT_EQ(mixed(calibrate(streams.a, streams.b)), nullptr);
}

/// A placeholder for a missing pose is no second path.
TEST(TwoSenders, APoseForNoneIsNoOtherSender) {
  testing::Streams streams = handheld(4);
  for (std::size_t i = 3; i < streams.b.size(); i += 5) streams.b[i].pose = DualQuaternion{};
  EXPECT_EQ(mixed(calibrate(streams.a, streams.b)), nullptr);
}

/// What shakes in place as fast as it is measured shakes both sensors: each world starts at its own sensor.
TEST(TwoSenders, WhatShakesBothIsOneSender) {
  testing::Streams streams = handheld(5);
  const DualQuaternion of_a = to_dual_quaternion(Pose{Rotation::Identity(), {0, 0, 0.5}});
  const DualQuaternion of_b = conjugate(streams.T) * of_a * streams.T;
  for (std::size_t i = 0; i < streams.a.size(); i += 2) {
    streams.a[i].pose = canonical_sign(normalized(of_a * streams.a[i].pose));
    streams.b[i].pose = canonical_sign(normalized(of_b * streams.b[i].pose));
  }
  EXPECT_EQ(mixed(calibrate(streams.a, streams.b)), nullptr);
}

}  // namespace
}  // namespace egocal::test_two_senders
