// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the supervisor decides about silent processes and about answers that are missing at the end of a log,
// in virtual time. Real processes: test_supervision.cpp.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <vector>

#include "supervision/last_answers.hpp"
#include "supervision/last_motions.hpp"
#include "supervision/silence.hpp"

namespace egocal::tools::test_supervision_decisions {
namespace {

using namespace std::chrono_literals;
using Next = Silence::Next;
using Time = LastAnswers::Time;

TEST(SilenceOfAProcess, IsReportedOnceThenTheProcessIsKilledOnce) {
  Silence silence;
  const SilenceOptions options;
  for (auto since = 0ms; since < options.silent; since += 1000ms)
    EXPECT_EQ(silence.look(since, 1s, true, options), Next::nothing) << since.count();
  EXPECT_EQ(silence.look(options.silent, 1s, true, options), Next::report_and_continue);
  for (auto since = options.silent + 1000ms; since <= options.hangs; since += 1000ms)
    EXPECT_EQ(silence.look(since, 1s, true, options), Next::nothing) << since.count();
  EXPECT_EQ(silence.look(options.hangs + 1000ms, 1s, true, options), Next::kill);
  // what is started in its place has said nothing yet
  EXPECT_EQ(silence.look(options.hangs + 2000ms, 1s, true, options), Next::nothing);
}

TEST(SilenceOfAProcess, ThatIsHeardAgainIsReportedOnce) {
  Silence silence;
  const SilenceOptions options;
  for (auto since = 0ms; since < options.silent; since += 1000ms) silence.look(since, 1s, true, options);
  EXPECT_EQ(silence.look(options.silent, 1s, true, options), Next::report_and_continue);
  EXPECT_EQ(silence.look(100ms, 1s, true, options), Next::report_heard);
  EXPECT_EQ(silence.look(200ms, 1s, true, options), Next::nothing);
}

// The network is away, or somebody stops all of them.
TEST(SilenceOfAProcess, WhereNobodyIsHeardNobodyIsBlamed) {
  Silence silence;
  for (auto since = 0ms; since < 3'600'000ms; since += 1000ms)
    ASSERT_EQ(silence.look(since, 1s, false, {}), Next::nothing) << since.count();
}

// The network goes away between the statuses of two processes.
TEST(SilenceOfAProcess, WhereAllFallSilentTheLastOneHeardBlamesNobody) {
  Silence silence;
  const SilenceOptions options;
  for (auto since = 0ms; since < 60'000ms; since += 1000ms)
    ASSERT_EQ(silence.look(since, 1s, since < options.heard, options), Next::nothing) << since.count();
}

// After an hour without a network the first that is heard does not condemn the second.
TEST(SilenceOfAProcess, CountsFromWhenAnotherOneIsHeard) {
  Silence silence;
  const SilenceOptions options;
  silence.look(1h, 1h, false, options);
  for (auto heard = 1000ms; heard < options.silent; heard += 1000ms)
    EXPECT_EQ(silence.look(1h + heard, 1s, true, options), Next::nothing) << heard.count();
  EXPECT_EQ(silence.look(1h + options.silent, 1s, true, options), Next::report_and_continue);
}

constexpr Work idle{};

/// Of processes that get this part of a core, at this time.
Work computing(double share, Time now) {
  return {.computes = true,
          .processor = std::chrono::duration_cast<std::chrono::nanoseconds>(share * now.time_since_epoch())};
}

TEST(LastAnswersOfALog, AreWaitedForWhileTheyCome) {
  LastAnswers answers({});
  Time now{};
  EXPECT_FALSE(answers.begun());
  for (int missing = 20; missing > 0; --missing)
    for (const Time end = now + 4s; now < end; now += 100ms) {
      EXPECT_TRUE(answers.wait_on(missing, idle, now)) << missing;
      EXPECT_TRUE(answers.begun());
    }
  EXPECT_FALSE(answers.wait_on(0, computing(1, now), now));
}

TEST(LastAnswersOfALog, AreGivenUpWhereNothingHappens) {
  LastAnswers answers({});
  Time now{};
  for (; now < Time{5s}; now += 100ms) ASSERT_TRUE(answers.wait_on(1, idle, now));
  EXPECT_FALSE(answers.wait_on(1, idle, now));
}

/// One that never ends is given up; a thirtieth of a core is not an end. After 60 s it was one.
TEST(LastAnswersOfALog, AreWaitedForByWhatTheProcessesHaveOfACore) {
  for (const int part : {1, 30}) {
    LastAnswers answers({.longest_stall = 60s});
    Time now{};
    for (; now < Time{part * 59s}; now += 100ms)
      ASSERT_TRUE(answers.wait_on(1, computing(1.0 / part, now), now)) << now.time_since_epoch().count();
    now = Time{part * 61s};
    EXPECT_FALSE(answers.wait_on(1, computing(1.0 / part, now), now)) << part;
  }
}

/// It waits for a disk that is gone, or somebody stops it again and again.
TEST(LastAnswersOfALog, AreNotWaitedForForEverWhereAProcessIsHeld) {
  LastAnswers answers({.longest_stall = 60s});
  Time now{};
  for (; now < Time{60s}; now += 100ms) ASSERT_TRUE(answers.wait_on(1, {.held = true}, now));
  EXPECT_FALSE(answers.wait_on(1, {.held = true}, now));
}

/// The process that waits has hardly any core either.
TEST(LastAnswersOfALog, AQuestionThatComesLateCountsForLittle) {
  LastAnswers answers({});
  Time now{};
  for (int i = 0; i < 10; ++i, now += 2s) ASSERT_TRUE(answers.wait_on(1, idle, now)) << i;
}

// Every second moment counts as idle.
TEST(LastAnswersOfALog, IdleTimeAddsUpBetweenWork) {
  LastAnswers answers({});
  Time now{};
  bool works = false;
  const auto wait_on = [&](int missing) {
    Work work = computing(0.5, now);
    work.computes = works;
    return answers.wait_on(missing, work, now);
  };
  for (; now < Time{9900ms}; now += 100ms, works = !works)
    ASSERT_TRUE(wait_on(2)) << now.time_since_epoch().count();
  for (; now < Time{10'200ms}; now += 100ms, works = !works) wait_on(2);
  works = false;
  EXPECT_FALSE(wait_on(2));
  EXPECT_TRUE(wait_on(1)) << "another one has come";
}

// It was the end: fewer had been missing before pairing found the last motions.
TEST(LastAnswersOfALog, MoreMotionsAreNewsAsWell) {
  LastAnswers answers({});
  Time now{};
  for (; now < Time{4s}; now += 100ms) ASSERT_TRUE(answers.wait_on(1, idle, now));
  for (; now < Time{8s}; now += 100ms)
    ASSERT_TRUE(answers.wait_on(15, idle, now)) << now.time_since_epoch().count();
}

TEST(LastAnswersOfALog, TwoSendersThatContradictEachOtherAreNotWaitedForForEver) {
  LastAnswers answers({});
  Time now{};
  int missing = 1;
  while (answers.wait_on(missing, computing(1, now), now) && now < Time{1h}) {
    now += 100ms;
    missing = 3 - missing;
  }
  EXPECT_LT(now, Time{1h});
}

/// Nothing was said for a minute, in which it seemed to hang.
TEST(LastAnswersOfALog, ThatAreWaitedForAreReportedMoreAndMoreSeldom) {
  LastAnswers answers({.report = 10s});
  std::vector<int> reported;
  for (Time now{}; now < Time{300s}; now += 100ms) {
    ASSERT_TRUE(answers.wait_on(1, computing(0.1, now), now));
    if (const std::optional<Waited> waited = answers.to_report()) {
      reported.push_back(static_cast<int>(waited->time / 1s));
      EXPECT_EQ(waited->processor, waited->time / 10);
    }
  }
  EXPECT_EQ(reported, (std::vector{10, 20, 40, 80, 160}));
}

problem_t problem_of(std::int64_t session, std::int64_t seq) {
  problem_t problem{};
  problem.sensor_a = "a";
  problem.sensor_b = "b";
  problem.session = session;
  problem.seq = seq;
  return problem;
}

TEST(LastMotionsOfALog, AreThoseThatPairingRepeats) {
  LastMotions motions;
  const PairName pair{"a", "b"};
  EXPECT_FALSE(motions.known(pair));
  motions.hear(problem_of(1, 5));
  EXPECT_FALSE(motions.known(pair));
  motions.hear(problem_of(1, 5));
  EXPECT_TRUE(motions.known(pair));
  motions.hear(problem_of(1, 6));
  EXPECT_FALSE(motions.known(pair)) << "there were more";
  motions.hear(problem_of(1, 6));
  motions.clear();
  EXPECT_FALSE(motions.known(pair)) << "the log has ended since";
  motions.hear(problem_of(1, 6));
  EXPECT_TRUE(motions.known(pair));
  motions.hear(problem_of(2, 6));
  EXPECT_FALSE(motions.known(pair)) << "another session";
}

}  // namespace
}  // namespace egocal::tools::test_supervision_decisions
