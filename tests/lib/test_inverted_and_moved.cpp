// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Both streams inverted by mistake hide that a mounting changed.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/arm_samples.hpp"
#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_inverted_and_moved {
namespace {

using testing::drive;
using testing::find;

/// Poses in two worlds that do not drift, with noise of their own.
testing::Streams tracked(std::uint64_t seed) {
  testing::Streams streams = drive(Terrain::free);
  testing::Random random(seed);
  for (Trajectory* const stream : {&streams.a, &streams.b})
    for (StampedPose& pose : *stream)
      pose.pose =
          canonical_sign(to_dual_quaternion(testing::noisy(to_pose(pose.pose), 0.001, 0.004, random)));
  return streams;
}

/// The transform between the worlds is the same whatever the mounting does: with both streams inverted by
/// mistake it is the answer, and fits.
TEST(InvertedAndMoved, AKnockIsNamedWhereBothStreamsAreInvertedByMistake) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const testing::Streams still = tracked(seed);
    testing::Streams wrong = still;
    wrong.b = testing::knocked(wrong.b, 0.5, {rotation_exp({0, 0.07, 0}), {0.05, 0, 0}});
    wrong.a = testing::inverted(wrong.a);
    wrong.b = testing::inverted(wrong.b);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    const Finding* both = find(calibration, "inverted_both");
    ASSERT_NE(both, nullptr) << seed << " " << calibration.reason;
    EXPECT_FALSE(both->certain);
    EXPECT_NE(both->message.find("the mounting changed about"), std::string::npos) << both->message;
    ASSERT_TRUE(both->T_a_b);
    const DualQuaternion before =
        to_dual_quaternion(*both->T_a_b) *
        conjugate(to_dual_quaternion(Pose{rotation_exp({0, 0.07, 0}), {0.05, 0, 0}}));
    EXPECT_LT(extrinsic_error(still.T, before).rotation, 0.01) << seed;
    const Calibration right = calibrate(still.a, still.b);
    EXPECT_LT(right.verdict, Verdict::doubtful) << right.reason;
    const Finding* const usual = find(right, "inverted_both");
    EXPECT_TRUE(usual == nullptr || usual->message.find("the mounting changed") == std::string::npos)
        << usual->message;
  }
}

/// Far from the origin of its world an inverted pose moves by its turns times the distance: what contradicts
/// is a small part of that, and streams that were inverted in vain agree.
TEST(InvertedAndMoved, StreamsThatOptionsInvertInVainAreDoubtful) {
  testing::Streams right = testing::bounded_drive();
  right.b = testing::with_late_positions(right.b, 3);
  const DualQuaternion far = to_dual_quaternion(Pose{{1, 0, 0, 0}, {60, 40, 0}}),
                       far_b = to_dual_quaternion(Pose{{1, 0, 0, 0}, {-50, 30, 2}});
  for (StampedPose& pose : right.a) pose.pose = far * pose.pose;
  for (StampedPose& pose : right.b) pose.pose = far_b * pose.pose;
  CalibrationOptions inverted;
  inverted.read_a.invert = inverted.read_b.invert = true;
  const Calibration wrong = calibrate(right.a, right.b, inverted);
  EXPECT_GE(wrong.verdict, Verdict::doubtful) << wrong.reason;
  const Finding* finding = find(wrong, "inverted_both");
  ASSERT_NE(finding, nullptr) << wrong.reason;
  if (!finding->certain) {
    ASSERT_TRUE(finding->value);
    EXPECT_GT(*finding->value, 1.5);
  }
}

/// Two cameras in orbit around one board, as solvePnP writes their poses: they travel further than the board
/// does before them.
TEST(InvertedAndMoved, CamerasThatWatchABoardAreRightlyInverted) {
  for (const double apart : {0.2, 1.0}) {
    testing::Random random(7);
    const Pose mounting{rotation_exp({0.1, -0.3, 0.2}), {apart, 0.05, -0.02}};
    const auto noisy = [&](const Pose& pose) {
      return to_dual_quaternion(pose * Pose{rotation_exp(random.normal3(0.001)), random.normal3(0.001)});
    };
    Trajectory a, b;
    for (int i = 0; i < 600; ++i) {
      const double t = 0.1 * i;
      // two metres from the board, and looking at it
      const Rotation towards(
          rotation_exp({0.5 * std::sin(0.31 * t), 0.6 * std::sin(0.23 * t), 0.4 * std::sin(0.17 * t)}));
      const Pose camera{towards, towards * Eigen::Vector3d(0, 0, -2 - 0.3 * std::sin(0.4 * t))};
      a.push_back({100'000 * i, conjugate(noisy(camera))});
      b.push_back({100'000 * i, conjugate(noisy(camera * mounting))});
    }
    CalibrationOptions inverted;
    inverted.read_a.invert = inverted.read_b.invert = true;
    const Calibration calibration = calibrate(a, b, inverted);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
    EXPECT_LT((calibration.T_a_b.translation - mounting.translation).norm(), 0.05);
  }
}

/// Right with the options: they are what such files need.
TEST(InvertedAndMoved, StreamsThatOptionsInvertRightlyAreGood) {
  testing::Streams files = testing::bounded_drive();
  const Verdict before = calibrate(files.a, files.b).verdict;
  files.a = testing::inverted(files.a);
  files.b = testing::inverted(files.b);
  CalibrationOptions inverted;
  inverted.read_a.invert = inverted.read_b.invert = true;
  const Calibration calibration = calibrate(files.a, files.b, inverted);
  EXPECT_EQ(calibration.verdict, before) << calibration.reason;
}

}  // namespace
}  // namespace egocal::test_inverted_and_moved
