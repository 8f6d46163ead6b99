// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One stream inverted by mistake hides that a mounting moved, and the wrong one seems to be it.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_moved_twin {
namespace {

using testing::drive;
using testing::find;

const Pose knock{rotation_exp({0.03, -0.05, 0.08}), {0.1, 0.05, 0}};

testing::Streams knocked_and_inverted(Terrain terrain, std::uint64_t seed) {
  testing::Streams wrong = drive(terrain, seed);
  wrong.b = testing::inverted(testing::knocked(wrong.b, 0.4, knock));
  return wrong;
}

/// With a inverted instead the answer is the transform between two worlds, which no knock changes: that
/// fitted better, and was called certain.
TEST(MovedTwin, BothStreamsAreNamedWhereAMoveExplainsTheOtherOne) {
  int right_first = 0, drives = 0;
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2, 4}) {
      const testing::Streams wrong = knocked_and_inverted(terrain, seed);
      const Calibration calibration = calibrate(wrong.a, wrong.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << " " << calibration.reason;
      const Finding *const of_a = find(calibration, "inverted_a"), *const of_b =
                                                                       find(calibration, "inverted_b");
      ASSERT_TRUE(of_a != nullptr && of_b != nullptr) << seed << " " << calibration.reason;
      EXPECT_FALSE(of_a->certain || of_b->certain) << seed;
      ++drives;
      if (of_b < of_a) ++right_first;
      if (of_b->message.find("mounting that moved") == std::string::npos) continue;
      ASSERT_TRUE(of_b->T_a_b);
      const ExtrinsicError after =
          extrinsic_error(wrong.T * to_dual_quaternion(knock), to_dual_quaternion(*of_b->T_a_b));
      EXPECT_LT(after.rotation, 0.03) << seed;
    }
  EXPECT_GE(right_first, drives - 1);
}

TEST(MovedTwin, WithoutAMoveTheInvertedStreamIsCertain) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    testing::Streams wrong = drive(Terrain::rough, seed);
    wrong.b = testing::inverted(wrong.b);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    testing::certain_finding(calibration, "inverted_b");
    EXPECT_EQ(find(calibration, "inverted_a"), nullptr) << seed;
  }
}

/// The cure of the wrong stream, by hand: one mounting fits, and that of both inverted with a move fits
/// better.
TEST(MovedTwin, AnAnswerBetweenTwoWorldsIsNotCalledGood) {
  for (const std::uint64_t seed : {3, 4}) {
    testing::Streams wrong = knocked_and_inverted(Terrain::free, seed);
    wrong.a = testing::inverted(wrong.a);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    EXPECT_EQ(calibration.verdict, Verdict::doubtful) << seed << " " << calibration.reason;
    const Finding* const both = find(calibration, "inverted_both");
    ASSERT_NE(both, nullptr) << seed;
    EXPECT_FALSE(both->certain);
    EXPECT_TRUE(both->time) << both->message;
  }
}

}  // namespace
}  // namespace egocal::test_moved_twin
