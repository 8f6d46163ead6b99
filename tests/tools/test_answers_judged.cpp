// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which verdict is that of an answer, and how much of the drive it has seen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "answers/answers.hpp"
#include "pair_messages.hpp"

namespace egocal::tools::test_answers_judged {
namespace {

TEST_F(AnswersTest, WhatIsKnownOfADirectionIsTheVerdictsToSay) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(to);
  answers.hear(answer(to));
  const Observability stated = answers.observability(pair_name);
  ASSERT_TRUE(stated.observable[3]);
  EXPECT_EQ(stated.stddev, answers.best(pair_name)->checked.answer.observability.stddev);
  verdict_t judged = verdict(Verdict::incomplete, begin_us, 9);
  judged.stddev_added[0] = 0.2;
  judged.stddev_added[3] = std::numeric_limits<double>::infinity();
  answers.hear(judged);
  const Observability shown = answers.observability(pair_name);
  EXPECT_DOUBLE_EQ(shown.stddev[0], std::hypot(stated.stddev[0], 0.2));
  EXPECT_FALSE(shown.observable[3]);
  EXPECT_TRUE(std::isinf(shown.stddev[3]));
  EXPECT_EQ(shown.stddev[5], stated.stddev[5]);

  const problem_t next = problem(1, begin_us + 1'000'000);
  answers.hear(next);
  answers.hear(answer(next));
  EXPECT_TRUE(answers.observability(pair_name).observable[3]) << "of another session";
}

// A mount may have moved since then.
TEST_F(AnswersTest, AVerdictOfAnEarlierPartOfTheDriveIsKnownToBeThat) {
  Answers answers;
  const auto drive_to = [&](std::int64_t seq) {
    const problem_t to = problem(seq);
    answers.hear(to);
    answers.hear(answer(to));
  };
  drive_to(10);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_FALSE(answers.seconds_not_judged(pair_name).has_value());
  answers.hear(verdict(Verdict::doubtful, begin_us, 10));
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
  EXPECT_EQ(answers.seconds_not_judged(pair_name), 0);
  drive_to(30);
  EXPECT_NE(answers.diagnosis(pair_name), nullptr);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_judged(pair_name).value_or(-1), 2, 1e-9);
  answers.hear(verdict(Verdict::contradictory, begin_us, 30));
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
}

// A busy diagnosis has the newest problem before the poses that it was made of: such a verdict was the last
// word of `egocal up` on a drive whose mount had moved.
TEST_F(AnswersTest, AVerdictByOldPosesIsNotOneOfTheEnd) {
  Answers answers;
  const problem_t newest = problem(100);
  answers.hear(newest);
  answers.hear(answer(newest));
  const DualQuaternion T_a_b = solve(*bus::to_problem(newest).value, Method::dual).T_a_b;
  verdict_t late = verdict(Verdict::incomplete, begin_us, 100, T_a_b);
  late.fit.poses = 60;
  late.utime_end = newest.utime - 4'000'000;
  answers.hear(late);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_judged(pair_name).value_or(-1), 4, 1e-9);
  late.utime_end = newest.utime - 1'000'000;
  answers.hear(late);
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
}

// The solvers hang, or were started with another rig.
TEST_F(AnswersTest, OneOfAnEarlierPartOfTheDriveIsKnownToBeThat) {
  Answers answers;
  EXPECT_TRUE(answers.answered_to_the_end(pair_name)) << "there is nothing to answer";
  const problem_t first = problem(10);
  answers.hear(first);
  EXPECT_FALSE(answers.answered_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 1, 1e-9);
  answers.hear(answer(first));
  EXPECT_TRUE(answers.answered_to_the_end(pair_name));
  EXPECT_EQ(answers.seconds_not_answered(pair_name), 0);
  answers.hear(problem(40));
  EXPECT_FALSE(answers.answered_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 3, 1e-9);
  answers.hear(problem(20, begin_us + 60'000'000));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 2, 1e-9) << "all of the new session";
}

// egocal solve prints the cure of what is possible as well.
TEST(VerdictLine, NamesWhatIsPossibleWithItsCure) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::doubtful;
  diagnosis.reason = "The mounting changed.";
  diagnosis.findings.push_back({"mount_moved", false, diagnosis.reason, "Reset the pair.", 2, {}, {}, {}});
  diagnosis.findings.push_back(
      {"inverted_both", false, "Both may be inverted.", "Look at them.", 1, {}, {}, {}});
  EXPECT_EQ(verdict_line(diagnosis), "doubtful: The mounting changed. Cure: Reset the pair.");
  EXPECT_THAT(possible_lines(diagnosis), ::testing::ElementsAre("Both may be inverted. Cure: Look at them."));
  diagnosis.verdict = Verdict::good;
  EXPECT_EQ(verdict_line(diagnosis), "good: The mounting changed.");
  EXPECT_EQ(possible_lines(diagnosis).size(), 2u);
  diagnosis.findings[0].certain = true;
  EXPECT_EQ(verdict_line(diagnosis), "good: The mounting changed. Cure: Reset the pair.");
}

}  // namespace
}  // namespace egocal::tools::test_answers_judged
