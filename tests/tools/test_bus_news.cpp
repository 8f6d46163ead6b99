// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What `egocal up` reports of a rig while it runs, by a clock that the test moves.
#include "supervision/bus_news.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "pair_messages.hpp"

namespace egocal::tools::test_bus_news {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::int64_t second = 1'000'000;

/// Two sensors of 10 Hz that pairing pairs, and a solver that answers everything.
class BusNewsTest : public AnswersTest {
 protected:
  BusNewsTest() {
    rig.sensors = {{"left", "LEFT", bus::OdometryType::odometry, {}},
                   {"right", "RIGHT", bus::OdometryType::odometry, {}}};
    rig.pairs.emplace_back().a = "left";
    rig.pairs.back().b = "right";
    pairing.name = "egocal-pairing";
    pairing.role = "pairing";
    pairing.state = "running";
    diagnosis.name = diagnosis.role = "diagnosis";
    diagnosis.state = "running";
    latest = problem(1);
  }

  /// Everything that was reported meanwhile.
  std::string run(double seconds) {
    if (!news) news.emplace(rig, options);
    std::string text;
    for (const std::int64_t end = now + static_cast<std::int64_t>(1e6 * seconds); now < end;
         now += second / 10) {
      StampedPose pose;
      pose.time_us = begin_us + now;
      if (left) news->hear("LEFT", bus::encode(bus::to_message(pose, now)), now);
      pose.time_us += ahead_us;
      if (right) news->hear("RIGHT", bus::encode(bus::to_message(pose, now)), now);
      if (pairs && left && right && ahead_us == 0) ++latest.seq;
      latest.utime = begin_us + now;
      const bool repeats = now % second == 0;
      if (repeats && pairing_runs) news->hear(pairing, now);
      if (repeats) news->hear(diagnosis, now);
      if (pairing_runs && latest.seq > 1 && (repeats || (left && right))) news->hear(latest, now);
      text += news->lines(answers, now);
    }
    return text;
  }
  void command(const std::string& verb, const std::string& to = "*") {
    command_t command{};
    command.to = to;
    command.verb = verb;
    news->hear(command, now);
  }

  bus::Rig rig;
  BusNewsOptions options;
  std::optional<BusNews> news;
  Answers answers;
  status_t pairing{}, diagnosis{};
  problem_t latest;
  std::int64_t now = 50 * second, ahead_us = 0;
  bool left = true, right = true, pairs = true, pairing_runs = true;
};

TEST_F(BusNewsTest, WhereAllIsWellNothingIsSaid) {
  EXPECT_EQ(run(100), "");
}

TEST_F(BusNewsTest, APairWithoutNewMotionsIsReportedOnceAndItsEndOnce) {
  run(10);
  right = false;
  EXPECT_EQ(run(4), "");
  EXPECT_EQ(run(100), "left -> right: no new motion for 5 s: right sends nothing\n");
  right = true;
  EXPECT_EQ(run(100), "left -> right: new motions come again\n");
}

TEST_F(BusNewsTest, StampsThatDoNotOverlapAreNamed) {
  run(10);
  ahead_us = 3600 * second;
  EXPECT_THAT(run(20),
              AllOf(HasSubstr("the stamps of the two streams do not overlap: those of right are 3600"),
                    HasSubstr("Set the clocks")));
}

TEST_F(BusNewsTest, BothSensorsThatAreSilentAreReportedLiveAndNotInALog) {
  run(10);
  left = right = false;
  EXPECT_EQ(run(20), "left -> right: no new motion for 5 s: left and right send nothing\n");
  news.reset();
  options.live = false;
  left = right = true;
  run(10);
  left = right = false;
  EXPECT_EQ(run(20), "");
}

TEST_F(BusNewsTest, ASensorThatNeverSendsIsNamed) {
  right = false;
  EXPECT_EQ(
      run(20),
      "left -> right: no motion yet: right sends nothing; `egocal listen` shows what is sent instead\n");
  right = true;
  EXPECT_EQ(run(20), "left -> right: new motions come again\n");
}

TEST_F(BusNewsTest, TheFirstMotionTakesItsTime) {
  pairs = false;
  EXPECT_EQ(run(60), "");
  EXPECT_EQ(run(20), "left -> right: no motion yet: pairing rejects the poses, see its counters\n");
}

TEST_F(BusNewsTest, WhatPairingRejectsIsNamedWithItsCure) {
  pairing.counters = {{"rejected: duplicate", 7}, {"rejected: gap", 1}, {"rejected: frozen", 0}};
  run(10);
  pairs = false;
  std::string text;
  for (int i = 0; i < 10; ++i) {
    pairing.counters[1].value += 1;
    pairing.counters[2].value += 9;
    text += run(1);
  }
  EXPECT_THAT(text,
              HasSubstr("no new motion for 5 s: pairing rejects the poses: frozen: one odometry repeats"));
}

TEST_F(BusNewsTest, WhyThereIsNothingIsWhatPairingRejectedMost) {
  pairing.counters = {
      {"rejected: gap", 59}, {"rejected: duplicate", 1}, {"rejected: frozen", 540}, {"in", 700}};
  pairs = false;
  run(2);
  EXPECT_THAT(news->why_nothing(),
              AllOf(HasSubstr("pairing found no motion: it rejected 540 x frozen (one odo"),
                    HasSubstr("(send each pose once)), 59 x gap (poses are further")));
  pairs = true;
  run(2);
  EXPECT_EQ(news->why_nothing(), "");
}

TEST_F(BusNewsTest, WhatComesAndGoesIsReportedOnceAMinute) {
  run(10);
  std::string text;
  for (int i = 0; i < 20; ++i) {
    right = i % 2 == 1;
    text += run(8);
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6) << text;
}

TEST_F(BusNewsTest, NothingIsReportedWhileAUserPauses) {
  run(10);
  command("pause");
  pairs = false;
  EXPECT_EQ(run(20), "");
  command("resume", "egocal-pairing");
  EXPECT_EQ(run(4), "");
  EXPECT_THAT(run(4), HasSubstr("pairing rejects the poses")) << "it is not paused";
  pairs = true;
  run(4);
  pairing.state = "paused";  // its status shows it, even if the command was lost
  pairs = false;
  EXPECT_EQ(run(20), "");
}

TEST_F(BusNewsTest, WherePairingIsSilentNoSensorIsBlamed) {
  run(10);
  pairing_runs = false;
  pairs = false;
  EXPECT_EQ(run(20), "");
  pairing_runs = true;
  EXPECT_EQ(run(3), "") << "it has just come back";
  pairs = true;
  EXPECT_EQ(run(20), "");
}

TEST_F(BusNewsTest, AnErrorIsReportedOnceAndItsEndOnce) {
  run(10);
  pairing.last_error = "state: cannot be written";
  EXPECT_EQ(run(200), "egocal-pairing: state: cannot be written\n");
  pairing.last_error.clear();
  EXPECT_EQ(run(200), "egocal-pairing: this is over: state: cannot be written\n");
}

// The state file of a process that is restarted without it is as bad as before.
TEST_F(BusNewsTest, AnErrorOfAProcessThatWasRestartedMayLast) {
  pairing.last_error = "state: cannot be written";
  run(10);
  pairing.last_error.clear();
  pairing.run += 1;
  EXPECT_EQ(run(200), "egocal-pairing: since its restart it no longer reports: state: cannot be written\n");
  pairing.last_error = "state: cannot be written";
  EXPECT_EQ(run(200), "egocal-pairing: state: cannot be written\n");
  pairing.last_error.clear();
  EXPECT_EQ(run(200), "egocal-pairing: this is over: state: cannot be written\n");
}

// A process that is restarted meets the same error within a second.
TEST_F(BusNewsTest, AnErrorThatIsMetAgainIsNotOver) {
  diagnosis.last_error = "state: cannot be written";
  EXPECT_EQ(run(10), "diagnosis: state: cannot be written\n");
  diagnosis.last_error.clear();
  run(1);
  diagnosis.last_error = "state: cannot be written";
  EXPECT_EQ(run(100), "");
}

// After "this is over" silence would mean that it is.
TEST_F(BusNewsTest, AnErrorThatComesBackIsReportedAgainOnceAMinute) {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    pairing.last_error = i % 2 == 0 ? "no network" : "";
    text += run(5);
  }
  EXPECT_EQ(text,
            "egocal-pairing: no network\negocal-pairing: this is over: no network\n"
            "egocal-pairing: no network\negocal-pairing: this is over: no network\n");
}

TEST_F(BusNewsTest, AStandbyWithoutAnErrorEndsNone) {
  pairing.last_error = "no network";
  EXPECT_EQ(run(5), "egocal-pairing: no network\n");
  status_t standby = pairing;
  standby.state = "waiting";
  standby.last_error.clear();
  std::string text;
  for (int i = 0; i < 20; ++i) {
    news->hear(standby, now);
    text += run(1);
  }
  EXPECT_EQ(text, "");
}

TEST_F(BusNewsTest, MotionsThatNoSolverAnswersAreReportedAndThatOneDoes) {
  run(10);
  answers.hear(problem(100));
  EXPECT_EQ(run(10), "left -> right: no solver answers the motions of the last 5 s\n");
  const problem_t newest = problem(101);
  answers.hear(newest);
  answers.hear(answer(newest));
  EXPECT_EQ(run(10), "left -> right: a solver answers again\n");
}

}  // namespace
}  // namespace egocal::tools::test_bus_news
