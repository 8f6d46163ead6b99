// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What `egocal up --log` prints at the end of a log: an answer of a part of it never looks like one of the
// log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "egocal/bus/log_file.hpp"
#include "pair_messages.hpp"
#include "supervision/log_extent.hpp"
#include "supervision/outcome.hpp"

namespace egocal::tools::test_outcome {
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
    extent.sensors["left"] = {begin_us, begin_us + 10 * second, {}, 0};
    extent.sensors["right"] = {begin_us + second / 10, begin_us + 10 * second, {}, 0};
    read_until = {{"LEFT", begin_us + 10 * second}, {"RIGHT", begin_us + 10 * second}};
    const problem_t end = problem(100);
    answers.hear(end);
    answers.hear(answer(end));
    const DualQuaternion judged = answers.best(pair_name)->checked.answer.T_a_b;
    answers.hear(verdict(Verdict::good, begin_us, 100, judged));
  }
  /// The log goes on for so long, at 10 Hz.
  void log_goes_on_to(std::int64_t seconds) {
    for (auto& [name, stream] : extent.sensors) {
      stream.last_us = begin_us + seconds * second;
      stream.poses.clear();
      for (std::int64_t time_us = stream.first_us; time_us <= stream.last_us; time_us += second / 10)
        stream.poses.add(time_us);
    }
    for (auto& [channel, until] : read_until) until = begin_us + seconds * second;
  }
  /// A problem and its answer. rejected: motions of the session so far that gave none.
  void hear(std::int64_t seconds, std::int64_t seq, std::int64_t rejected = 0) {
    problem_t next = problem(seq);
    next.utime = begin_us + seconds * second;
    next.rejected = rejected;
    answers.hear(next);
    answers.hear(answer(next));
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

// Its numbers were printed without a word.
TEST_F(OutcomeTest, WhatTheMotionsDoNotShowIsNamed) {
  EXPECT_THAT(outcome().text, Not(HasSubstr("OBSERVABLE")));
  verdict_t judged = verdict(Verdict::incomplete, begin_us, 100);
  for (const std::size_t i : {2, 3, 4}) judged.stddev_added[i] = std::numeric_limits<double>::infinity();
  answers.hear(judged);
  EXPECT_THAT(outcome().text, HasSubstr("\n  NOT OBSERVABLE, not a measurement: z roll pitch"));
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

// The mount was knocked in the part that the diagnosis had no time for.
TEST_F(OutcomeTest, WhoseAnswerHasMovedSinceItWasJudgedIsUnusable) {
  Pose moved = to_pose(T);
  moved.translation.x() += 0.9;
  T = to_dual_quaternion(moved);
  const problem_t later = problem(150);
  answers.hear(later);
  answers.hear(answer(later));
  ASSERT_TRUE(answers.departure(pair_name));
  EXPECT_NEAR(answers.departure(pair_name)->translation, 0.9, 0.1);
  EXPECT_TRUE(outcome().unusable);
  EXPECT_THAT(outcome().text, StartsWith("left -> right: the last 5.0 s are not judged, and the answer has "
                                         "moved by "));
  EXPECT_THAT(outcome().text, HasSubstr(" since it was judged. Before: good: "));
  answers.hear(verdict(Verdict::good, begin_us, 150, answers.best(pair_name)->checked.answer.T_a_b));
  EXPECT_FALSE(answers.departure(pair_name));
  EXPECT_FALSE(outcome().unusable);
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

// Half of the drive was missing in an answer that was called good, without a word.
TEST_F(OutcomeTest, AfterAClockWentBackSaysSo) {
  for (auto& [name, stream] : extent.sensors) stream.earlier_us = 30 * second;
  const auto says_so = HasSubstr(
      "the first 30.0 s of the log are not in this answer: a sensor's clock went back, and the statistics "
      "began anew");
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text, says_so);
  // of one sensor, by an hour: the session was numbered after the one before it
  extent.sensors["right"].earlier_us = 0;
  extent.sensors["left"].first_us -= 3600 * second;
  extent.sensors["left"].last_us -= 3600 * second;
  EXPECT_THAT(outcome().text, says_so);
}

// A camera restarted with times of its own, of which no motion can be made: its first half was the answer,
// and the line said that this half was missing.
TEST_F(OutcomeTest, OfTheTimeBeforeAClockWentBackIsOld) {
  extent.sensors["left"].begin_us = begin_us;
  extent.sensors["right"].begin_us = begin_us + second / 10;
  extent.sensors["right"].earlier_us = 10 * second;
  extent.sensors["right"].first_us = second;
  extent.sensors["right"].last_us = 56 * second;
  EXPECT_TRUE(outcome().unusable);
  EXPECT_THAT(outcome().text,
              StartsWith("left -> right: old answer, the last 55.0 s of the log are not in it (a sensor's "
                         "clock went back, and no motion was found after that). Before: good: "));
  EXPECT_THAT(outcome().text, Not(HasSubstr("the first")));
}

TEST_F(OutcomeTest, OfASensorThatWasSilentSaysSo) {
  extent.sensors["right"].messages = 301;
  extent.sensors["right"].silent_from_us = 30 * second;
  extent.sensors["right"].silent_until_us = 90 * second;
  EXPECT_FALSE(outcome().unusable) << "the answer holds all that there is";
  EXPECT_THAT(outcome().text, HasSubstr("\nright: no pose from 30.0 to 90.0 s of the log\n"));
  extent.sensors["right"].messages = 2;
  EXPECT_THAT(outcome().text, Not(HasSubstr("no pose"))) << "a message in 10 s";
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

// A seventh of the messages was cut in half, and only a monitor showed it.
TEST_F(OutcomeTest, OfALogWithUnreadableMessagesSaysSo) {
  EXPECT_THAT(outcome().text, Not(HasSubstr("can be read")));
  extent.unreadable["right"] = 256;
  EXPECT_THAT(outcome().text, HasSubstr("right: 256 messages of the log hold no pose that can be read\n"));
}

TEST_F(OutcomeTest, OfADamagedLogSaysSo) {
  extent.damage.lost_events = 12;
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text,
              HasSubstr("\nthe log is damaged: at least 12 events are lost and in no answer; see "
                        "egocal log check\n"));
}

// A region of most of the log was "about 1 of its events".
TEST_F(OutcomeTest, OfALogOfWhichMostIsDestroyedStatesTheBytes) {
  extent.damage = {.regions = 1, .bytes = 249958, .lost_events = 1, .jumps = 0, .truncated = true};
  EXPECT_THAT(outcome().text,
              HasSubstr("the log is damaged: 249958 bytes in 1 region and at least 1 event are lost "
                        "and in no answer, and its end is cut off; see egocal log check\n"));
}

// By a seek of the player, a pause of pairing, or messages that are lost. It was "good", without a remark.
TEST_F(OutcomeTest, WithAHoleInItsMiddleSaysSo) {
  log_goes_on_to(150);
  hear(27, 270);
  hear(131, 280);
  hear(150, 470);
  EXPECT_FALSE(outcome().unusable);
  EXPECT_THAT(outcome().text,
              HasSubstr("  about 103.0 s in the middle of the log are not in this answer, between 27.0 "
                        "and 131.0 s: pairing did not get them, or was paused\n"));
}

TEST_F(OutcomeTest, ThatHoldsEveryMotionOfTheLogHasNoHole) {
  log_goes_on_to(150);
  hear(27, 270);
  hear(131, 1290);
  hear(150, 1460, 20);  // 20 were rejected, and some are lost around them
  EXPECT_THAT(outcome().text, Not(HasSubstr("middle")));
}

// Motions of a second begin every quarter of one where the scale is to be found.
TEST_F(OutcomeTest, OfAScaleThatWasFoundHasNoHole) {
  rig.sensors[1].find_scale = true;
  log_goes_on_to(150);
  hear(27, 157);
  hear(131, 500);
  hear(150, 564);
  EXPECT_THAT(outcome().text, Not(HasSubstr("middle")));
}

TEST_F(OutcomeTest, WithManySmallHolesSaysSo) {
  log_goes_on_to(150);
  for (std::int64_t seconds = 11; seconds <= 150; ++seconds) hear(seconds, 100 + 7 * (seconds - 10));
  EXPECT_THAT(outcome().text,
              HasSubstr("  about 42.0 s in the middle of the log are not in this answer, between 0.0 "
                        "and 150.0 s"));
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
  const PoseCounts& poses = found.sensors.at("left").poses;
  EXPECT_EQ(poses.between(begin_us - 1'000'000, begin_us + 4 * second), 5);
  EXPECT_EQ(poses.between(begin_us, begin_us + 2 * second), 2);
  EXPECT_EQ(poses.between(begin_us + 4 * second, begin_us + 9 * second), 0);
  EXPECT_DOUBLE_EQ(poses.period(), 1);
  EXPECT_EQ(found.unreadable, (std::map<std::string, std::int64_t>{{"left", 1}}));
  EXPECT_FALSE(found.damage.any());
}

TEST_F(OutcomeTest, TheExtentOfALogWhoseClockWentBackIsThatOfTheLastTimeline) {
  const std::string log = folder / "back.log";
  {
    bus::LogWriter writer(log);
    for (int i = 0; i < 600; ++i) {
      const std::int64_t time_us = begin_us + i * second / 10 - (i < 300 ? 0 : 3600 * second);
      writer.write(i, "LEFT", bus::encode(bus::to_message(StampedPose{time_us, {}}, i)));
    }
    writer.close();
  }
  bus::LogReader reader(log);
  const LogExtent::Stream left = log_extent(reader, rig).sensors.at("left");
  EXPECT_EQ(left.first_us, begin_us - 3570 * second);
  EXPECT_EQ(left.last_us, begin_us - 3570 * second + 29 * second + 900'000);
  EXPECT_EQ(left.earlier_us, 29 * second + 900'000);
  EXPECT_EQ(left.poses.between(begin_us - 3580 * second, begin_us), 300);
}

TEST_F(OutcomeTest, TheExtentKnowsTheLongestSilence) {
  const std::string log = folder / "silent.log";
  {
    bus::LogWriter writer(log);
    for (int i = 0; i < 90; ++i)
      for (const char* channel : {"LEFT", "RIGHT"})
        if (channel[0] == 'L' ? i < 30 || i >= 60 : i >= 5 && i < 70)
          writer.write(i * second, channel, bus::encode(bus::to_message(StampedPose{i * second, {}}, i)));
    writer.close();
  }
  bus::LogReader reader(log);
  LogExtent found = log_extent(reader, rig);
  const LogExtent::Stream &left = found.sensors.at("left"), &right = found.sensors.at("right");
  EXPECT_EQ(left.silent_from_us, 29 * second);
  EXPECT_EQ(left.silent_until_us, 60 * second);
  EXPECT_EQ(left.messages, 60);
  EXPECT_EQ(right.silent_from_us, 69 * second) << "at the end, which is longer than at the begin";
  EXPECT_EQ(right.silent_until_us, 89 * second);
}

// One flipped bit: "camera: no pose from 29.9 to 1925.4 s" of a log of 30 s.
TEST_F(OutcomeTest, ADamagedTimeIsNoSilence) {
  const std::string log = folder / "damaged.log";
  {
    bus::LogWriter writer(log);
    for (int i = 0; i < 30; ++i)
      for (const char* channel : {"LEFT", "RIGHT"}) {
        const bool damaged = channel[0] == 'L' && (i == 0 || i == 20);
        writer.write(i * second + (damaged ? 2000 * second : 0), channel,
                     bus::encode(bus::to_message(StampedPose{i * second, {}}, i)));
      }
    writer.close();
  }
  bus::LogReader reader(log);
  LogExtent found = log_extent(reader, rig);
  for (const char* name : {"left", "right"}) {
    const LogExtent::Stream& stream = found.sensors.at(name);
    EXPECT_LE(stream.silent_until_us - stream.silent_from_us, 2 * second) << name;
    EXPECT_GE(stream.messages, 28) << name;
  }
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
}  // namespace egocal::tools::test_outcome
