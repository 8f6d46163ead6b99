// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What `egocal up --log` prints at the end of a log: an answer of a part of it never looks like one of the
// log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "egocal/bus/log_file.hpp"
#include "pair_messages.hpp"
#include "supervision/log_extent.hpp"
#include "supervision/outcome.hpp"

namespace egocal::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::int64_t second = 1'000'000;

class OutcomeTest : public AnswersTest {
 protected:
  OutcomeTest() {
    rig.sensors = {{"left", "LEFT", bus::OdometryType::odometry, {}},
                   {"right", "RIGHT", bus::OdometryType::odometry, {}}};
    rig.pairs.emplace_back().a = "left";
    rig.pairs.back().b = "right";
    extent.sensors["left"] = {begin_us, begin_us + 10 * second};
    extent.sensors["right"] = {begin_us + second / 10, begin_us + 10 * second};
    read_until = {{"LEFT", begin_us + 10 * second}, {"RIGHT", begin_us + 10 * second}};
    const problem_t end = problem(100);
    answers.hear(end);
    answers.hear(answer(end));
    const DualQuaternion judged = answers.best(pair_name)->checked.answer.T_a_b;
    answers.hear(verdict(Verdict::good, begin_us, 100, judged));
  }
  Outcome outcome() const { return outcome_of(rig, answers, extent, read_until); }

  bus::Rig rig;
  Answers answers;
  LogExtent extent;
  ReadUntil read_until;
};

TEST_F(OutcomeTest, OfAWholeLogIsTheVerdict) {
  EXPECT_TRUE(outcome().answered);
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text, StartsWith("left -> right: good: "));
  EXPECT_THAT(outcome().text, Not(HasSubstr("log")));
}

TEST_F(OutcomeTest, WhatIsMissedIsAnOption) {
  read_until["RIGHT"] = begin_us + 7 * second;
  EXPECT_TRUE(outcome().unusable);
  EXPECT_FALSE(outcome_of(rig, answers, extent, read_until, {.least_missing = 4}).unusable);
}

TEST_F(OutcomeTest, WithoutTheEndThatNoSolverAnsweredIsUnusable) {
  const problem_t later = problem(150);
  answers.hear(later);
  EXPECT_TRUE(outcome().unusable);
  EXPECT_THAT(outcome().text,
              StartsWith("left -> right: old answer, the last 5.0 s of the log are not in it (no "
                         "solver answered them), and the last 5.0 s are not judged. Before: good: "));
  answers.hear(answer(later));
  EXPECT_FALSE(outcome().unusable) << "the verdict alone is missing, and that is said";
  EXPECT_THAT(outcome().text, StartsWith("left -> right: the last 5.0 s are not judged. Before: good: "));
}

TEST_F(OutcomeTest, WithoutTheEndThatPairingDidNotReadIsUnusable) {
  read_until["RIGHT"] -= 4 * second;
  EXPECT_TRUE(outcome().unusable);
  EXPECT_THAT(outcome().text, StartsWith("left -> right: old answer, the last 4.0 s of the log are not in it "
                                         "(pairing did not read them). Before: good: "));
  read_until["RIGHT"] += 4 * second - second / 5;
  EXPECT_FALSE(outcome().unusable) << "it waits for a neighbour";
}

TEST_F(OutcomeTest, ThatBeginsLateSaysSo) {
  extent.sensors["left"].first_us -= 60 * second;
  extent.sensors["right"].first_us -= 55 * second;
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text, HasSubstr("the first 54.9 s of the log are not in this answer"));
  // of clocks that differ by an hour the session began with the other one's pose
  extent.sensors["left"].first_us = begin_us;
  extent.sensors["right"].first_us = begin_us - 3600 * second;
  EXPECT_THAT(outcome().text, Not(HasSubstr("are not in this answer")));
}

// All processes were restarted with another rig: pairing read the rest, for a pair of another name.
TEST_F(OutcomeTest, WhoseLastMotionIsFarFromTheEndSaysSo) {
  for (auto& [name, stream] : extent.sensors) stream.last_us += 30 * second;
  for (auto& [channel, until] : read_until) until += 30 * second;
  EXPECT_FALSE(outcome().unusable) << "the sensor may have been frozen";
  EXPECT_THAT(outcome().text, HasSubstr("the last 30.0 s of the log are not in this answer: no new motion"));
  // one sensor ended earlier
  extent.sensors["right"].last_us -= 27 * second;
  EXPECT_THAT(outcome().text, Not(HasSubstr("are not in this answer")));
}

TEST_F(OutcomeTest, OfADamagedLogSaysSo) {
  extent.damage.lost_events = 12;
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text, HasSubstr("the log is damaged: about 12 of its events could not be read"));
}

TEST_F(OutcomeTest, TheExtentOfALogIsInTheSensorsTime) {
  const std::string log = folder / "drive.log";
  {
    bus::LogWriter writer(log);
    for (int i = 0; i < 5; ++i) {
      writer.write(i, "LEFT", bus::encode(bus::to_message(StampedPose{begin_us + i * second, {}}, i)));
      writer.write(i, "OTHER", {});
    }
    odometry_t damaged = bus::to_message(StampedPose{begin_us, {}}, 5);
    damaged.utime = -7;
    writer.write(5, "LEFT", bus::encode(damaged));
    writer.close();
  }
  bus::LogReader reader(log);
  ASSERT_TRUE(reader.next());
  std::filesystem::remove(log);  // held open
  const LogExtent found = log_extent(reader, rig);
  ASSERT_EQ(found.sensors.size(), 1u);
  EXPECT_EQ(found.sensors.at("left").first_us, begin_us);
  EXPECT_EQ(found.sensors.at("left").last_us, begin_us + 4 * second);
  EXPECT_FALSE(found.damage.any());
}

// It was "no solver answered".
TEST_F(OutcomeTest, OfALogThatWasEmptiedMeanwhileIsUnusableAndIsPrinted) {
  extent = {};
  EXPECT_TRUE(outcome().answered);
  EXPECT_TRUE(outcome().unusable);
  EXPECT_THAT(outcome().text, StartsWith("left -> right: good: "));
  EXPECT_THAT(outcome().text, HasSubstr("the log holds no poses any more"));
}

}  // namespace
}  // namespace egocal::tools
