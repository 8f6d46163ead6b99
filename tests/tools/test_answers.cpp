// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which answer counts: verified by the listener, of the right session and pair.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "pair_messages.hpp"

namespace egocal::tools::test_answers {
namespace {

TEST_F(AnswersTest, TheCertifiedOneCountsInWhateverOrderTheyAreHeard) {
  const problem_t to = problem(10);
  const calibration_t good = answer(to), poor = poor_answer(to, 3);
  for (const bool poor_first : {true, false})
    for (const bool problem_first : {true, false}) {
      Answers answers;
      if (problem_first) answers.hear(to);
      answers.hear(poor_first ? poor : good);
      if (!problem_first) answers.hear(to);
      answers.hear(poor_first ? good : poor);
      const Answers::Best* best = answers.best(pair_name);
      ASSERT_NE(best, nullptr);
      EXPECT_TRUE(best->certified());
      EXPECT_EQ(best->message.solver, "egocal-global");
    }
}

TEST_F(AnswersTest, OneHeardBeforeItsProblemIsVerifiedWhenThatComes) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(answer(to));
  ASSERT_NE(answers.best(pair_name), nullptr);
  EXPECT_FALSE(answers.best(pair_name)->certified()) << "the sender's word is no proof";
  answers.hear(to);
  EXPECT_TRUE(answers.best(pair_name)->certified());
}

/// A second pairing process took over for a while, or the disk had no room for the newest session.
TEST_F(AnswersTest, FollowProblemsWhoseNumbersGoBackForGood) {
  Answers answers;
  const auto come = [&](std::int64_t seq, std::int64_t session) {
    const problem_t to = problem(seq, session);
    answers.hear(to);
    answers.hear(answer(to));
    return answers.best(pair_name)->message.session;
  };
  EXPECT_EQ(come(50, begin_us + 1'000'000), begin_us + 1'000'000);
  EXPECT_EQ(come(10, begin_us), begin_us + 1'000'000) << "one that is late";
  EXPECT_EQ(come(51, begin_us + 1'000'000), begin_us + 1'000'000);
  for (std::int64_t seq = 11; seq <= 13; ++seq) come(seq, begin_us);
  EXPECT_EQ(answers.best(pair_name)->message.session, begin_us);
  EXPECT_EQ(answers.best(pair_name)->message.seq, 13);
}

TEST_F(AnswersTest, ForgedOnesCountForNothing) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(to);
  answers.hear(answer(to));
  calibration_t forged = answer(to);
  forged.solver = "forger";
  forged.pos[0] = forged.pos[1] = forged.pos[2] = 9;
  forged.cost = forged.lower_bound = forged.gap = forged.scaled_gap = 0;
  answers.hear(forged);  // a lower cost for the same problem
  for (const std::int64_t session : {begin_us, begin_us + 1'000'000'000}) {
    forged.session = session;
    forged.seq = 1'000'000;
    answers.hear(forged);  // of a problem to come
  }
  const Answers::Best* best = answers.best(pair_name);
  ASSERT_NE(best, nullptr);
  EXPECT_TRUE(best->certified());
  EXPECT_EQ(best->message.solver, "egocal-global");
  EXPECT_EQ(answers.refused().size(), 1u);
}

TEST_F(AnswersTest, OfALogIsTheSessionThatRanAtItsEnd) {
  const std::string log = folder / "session.log";
  {
    bus::LogWriter writer(log);
    const auto write = [&](const problem_t& to) {
      writer.write(to.utime, bus::problem_channel("left", "right"), bus::encode(to));
      writer.write(to.utime, bus::calibration_channel("left", "right"), bus::encode(answer(to)));
    };
    for (int i = 1; i <= 5; ++i) write(problem(i, begin_us, static_cast<std::uint64_t>(100 + i)));
    // a second pairing process sent for a moment, under a higher session
    for (int i = 1; i <= 3; ++i) write(problem(i, begin_us + 12'000'000, static_cast<std::uint64_t>(20 + i)));
    for (int i = 6; i <= 9; ++i) write(problem(i, begin_us, static_cast<std::uint64_t>(100 + i)));
    writer.close();
  }
  const Answers answers = recorded_answers(log);
  const Answers::Best* best = answers.best(pair_name);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->message.session, begin_us);
  EXPECT_EQ(best->message.seq, 9);
  EXPECT_EQ(best->message.pairs, 109);
  EXPECT_TRUE(best->certified());
}

}  // namespace
}  // namespace egocal::tools::test_answers
