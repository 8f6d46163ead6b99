// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Both streams inverted by mistake hide that a mounting changed.
#include <gtest/gtest.h>

#include "../support/arm_samples.hpp"
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

}  // namespace
}  // namespace egocal::test_inverted_and_moved
