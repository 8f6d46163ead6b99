// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One rule for the monitor and for `egocal up`: when an answer is no longer one of the present.
#include <gtest/gtest.h>

#include "egocal/bus/answer_age.hpp"

namespace egocal::bus::test_answer_age {
namespace {

constexpr std::int64_t second = 1'000'000;

TEST(AnswerAge, IsOldWhereNothingAnswersForAWhile) {
  AnswerAge age;
  const AnswerAgeOptions options;
  age.note({1, 7}, true, 10 * second);
  age.note({1, 7}, true, 14 * second);
  EXPECT_EQ(age.old(15 * second, options), 0);
  EXPECT_EQ(age.old(16 * second, options), 6);
  EXPECT_EQ(age.old(16 * second, {.answered_within = 10}), 0);
}

TEST(AnswerAge, ASolverThatIsSlowStillFollows) {
  AnswerAge age;
  for (std::int64_t i = 0; i < 20; ++i) age.note({1, i}, true, i * 4 * second);
  EXPECT_EQ(age.old(77 * second, {}), 0);
  // the same number in another session is another answer
  age.note({2, 19}, true, 80 * second);
  EXPECT_EQ(age.old(84 * second, {}), 0);
  EXPECT_EQ(age.old(86 * second, {}), 6);
}

TEST(AnswerAge, AnAnswerToTheNewestProblemIsNeverOld) {
  AnswerAge age;
  EXPECT_EQ(age.old(100 * second, {}), 0);
  age.note({1, 7}, true, 0);
  age.note({1, 9}, false, second);
  EXPECT_EQ(age.old(100 * second, {}), 0);
  age.note({1, 9}, true, 100 * second);
  age.forget();
  EXPECT_EQ(age.old(200 * second, {}), 0);
}

}  // namespace
}  // namespace egocal::bus::test_answer_age
