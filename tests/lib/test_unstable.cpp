// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Directions that hinge on a part of the drive are not printed as known.
#include <gtest/gtest.h>

#include "../support/motions_of_a.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::test_unstable {
namespace {

/// Four fifths go straight along x of a, which shows nothing of roll; the last one turns.
Answered shown_by_the_last_fifth(double stddev) {
  const double noise = 0.01;
  std::vector<MotionPair> pairs =
      testing::motions_of_a(testing::T_a_b, 400, noise, 1, [](testing::Random& random) {
        return testing::displacement({0, 0, 0}, {1 + 0.1 * random.normal(), 0, 0});
      });
  const std::vector<MotionPair> turns =
      testing::motions_of_a(testing::T_a_b, 100, noise, 2, testing::planar_motion_of_a);
  pairs.insert(pairs.end(), turns.begin(), turns.end());
  Answered answered;
  answered.problem = testing::problem_of(pairs);
  const Answer answer = solve(answered.problem, Method::dual);
  answered.T_a_b = answer.T_a_b;
  answered.observability = answer.observability;
  answered.observability.observable.fill(true);
  answered.observability.stddev.fill(stddev);
  return answered;
}

TEST(Unstable, ADirectionIsNoBetterKnownThanWithoutAFifthOfTheDrive) {
  const Diagnosis diagnosis = diagnose(shown_by_the_last_fifth(0.001), {});
  EXPECT_EQ(diagnosis.verdict, Verdict::incomplete);
  EXPECT_GT(diagnosis.timing_stddev[3], DiagnosisOptions().tolerance_rotation);
  EXPECT_EQ(diagnosis.timing_stddev[4], 0);
  EXPECT_EQ(diagnosis.timing_stddev[5], 0);
}

TEST(Unstable, AStandardDeviationThatSaysSoStays) {
  const Diagnosis diagnosis = diagnose(shown_by_the_last_fifth(10), {});
  for (const double more : diagnosis.timing_stddev) EXPECT_EQ(more, 0);
}

}  // namespace
}  // namespace egocal::test_unstable
