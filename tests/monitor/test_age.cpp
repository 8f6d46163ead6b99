// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// An old answer never looks like a current one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/view.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_age {
namespace {

using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class AnswerAge : public ::testing::Test {
 protected:
  AnswerAge() { view.charset = Charset::unicode; }
  static Now at(double seconds) {
    const auto us = static_cast<std::int64_t>(1e6 * seconds);
    return {1'000'000'000 + us, 1'600'000'100'000'000 + us};
  }
  /// Ten problems a second, each answered and judged where there is somebody to do it.
  void drive(double from, double to, bool solver, bool pairing = true) {
    for (int i = 0; from + 0.1 * i < to; ++i) {
      const Now now = at(from + 0.1 * i);
      if (pairing) {
        problem = test::problem_at("lidar", "camera", ++step, 10);
        model.on_problem(problem, now);
      }
      if (solver) model.on_calibration(test::calibration_at(problem, false), now);
      if (solver && pairing) judge(now);
      model.tick(now);
    }
  }
  void judge(Now now, Verdict verdict = Verdict::good) {
    Diagnosis diagnosis;
    diagnosis.verdict = verdict;
    diagnosis.reason = "The motions agree.";
    const verdict_t message = test::verdict_at(diagnosis, problem.utime, problem.session, problem.seq);
    const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
    ASSERT_TRUE(received) << received.reason;
    model.on_verdict(message, *received.value, now);
  }
  /// The newest problem, answered anew.
  void answer_moved_by(double degrees, double metres) {
    calibration_t answer = test::calibration_at(problem, false);
    Pose T = test::extrinsic_at(static_cast<double>(problem.seq));
    T.rotation = T.rotation * rotation_exp({0, 0, degrees * std::numbers::pi / 180});
    T.translation.y() += metres;
    bus::set_pose(to_dual_quaternion(T), answer.pos, answer.quat);
    model.on_calibration(answer, at(1));
  }
  std::string shown(Screen screen) {
    view.screen = screen;
    Canvas canvas(110, 42);
    draw(canvas, model, view);
    return canvas.to_text();
  }
  void expect_old(const std::string& why) {
    for (const Screen screen : {Screen::overview, Screen::detail}) {
      EXPECT_THAT(shown(screen), HasSubstr("? old answer"));
      EXPECT_THAT(shown(screen), Not(HasSubstr("✓ good")));
      EXPECT_THAT(shown(screen), HasSubstr(why));
      EXPECT_THAT(shown(screen), Not(ContainsRegex("(motions|age) +now"))) << "solvers repeat it";
    }
    EXPECT_THAT(shown(Screen::overview), HasSubstr("0 of 1 good  1 old"));
    EXPECT_THAT(pair_lines(model, Charset::ascii), HasSubstr("lidar -> camera: ? old answer: " + why));
    EXPECT_EQ(nlohmann::json::parse(json_line(model))["pairs"][0]["answer_old"], true);
    const std::optional<NamedExtrinsic> exported = extrinsic_of(model.pairs()[0]);
    ASSERT_TRUE(exported);
    EXPECT_FALSE(exported->usable);
  }
  void expect_good() {
    EXPECT_THAT(shown(Screen::overview), HasSubstr("✓ good"));
    EXPECT_THAT(shown(Screen::overview), HasSubstr("1 of 1 good  1 proven"));
    EXPECT_EQ(nlohmann::json::parse(json_line(model))["pairs"][0]["answer_old"], false);
    EXPECT_TRUE(extrinsic_of(model.pairs()[0])->usable);
  }

  Model model;
  ViewState view;
  problem_t problem;
  int step = 100;
};

TEST_F(AnswerAge, SolversThatHangLeaveAnOldOne) {
  drive(0, 10, true);
  expect_good();
  drive(10, 13, false);
  expect_good();
  drive(13, 40, false);
  expect_old("no solver answers what came in the last 30");
  EXPECT_EQ(
      std::count_if(model.events().begin(), model.events().end(),
                    [](const Event& e) { return e.text.find("the answer is old") != std::string::npos; }),
      1);
  drive(40, 41, true);
  expect_good();
}

// At full speed a mount was knocked within the second between two verdicts.
TEST_F(AnswerAge, OneThatHasMovedSinceItWasJudgedHasAnOldVerdict) {
  drive(0, 1, true);
  answer_moved_by(0.9, 0.5);
  expect_good();  // as far as a good answer may be off
  answer_moved_by(1.7, 0.02);
  const std::string why = "the answer has moved by 1.70 deg and 2 cm since it was judged. Before: good.";
  for (const Screen screen : {Screen::overview, Screen::detail}) {
    EXPECT_THAT(shown(screen), Not(HasSubstr("✓ good")));
    EXPECT_THAT(shown(screen), HasSubstr("? old verdict"));
    EXPECT_THAT(shown(screen), HasSubstr(why));
  }
  EXPECT_THAT(shown(Screen::overview), HasSubstr("0 of 1 good"));
  EXPECT_THAT(pair_lines(model, Charset::ascii), HasSubstr("lidar -> camera: ? old verdict: " + why));
  EXPECT_EQ(nlohmann::json::parse(json_line(model))["pairs"][0]["verdict_old"], true);
  const std::optional<NamedExtrinsic> exported = extrinsic_of(model.pairs()[0]);
  ASSERT_TRUE(exported);
  EXPECT_FALSE(exported->usable);
  EXPECT_EQ(exported->verdict, "");
  EXPECT_THAT(exported->reason, HasSubstr("since it was judged"));
  answer_moved_by(0, 0.7);
  EXPECT_THAT(shown(Screen::overview), HasSubstr("? old verdict"));
  judge(at(1), Verdict::incomplete);
  EXPECT_THAT(shown(Screen::overview), HasSubstr("incomplete")) << "it does not say where the answer is";
}

TEST_F(AnswerAge, ASolverThatSkipsProblemsFollows) {
  for (int i = 0; i < 20; ++i) {
    drive(2.0 * i, 2.0 * i + 1.9, false);
    drive(2.0 * i + 1.9, 2.0 * i + 2, true);
    EXPECT_THAT(shown(Screen::overview), Not(HasSubstr("old answer")));
  }
}

// Its solvers repeat their answer once a second.
TEST_F(AnswerAge, APairingThatHangsLeavesAnOldOne) {
  drive(0, 10, true);
  drive(10, 40, true, false);
  expect_old("pairing is silent for 30");
  drive(40, 41, true);
  expect_good();
}

// A camera started again with times of its own: pairing runs, and finds no motion in its new session. The
// monitor said that pairing is silent, and nothing of the cause.
TEST_F(AnswerAge, ASessionWithoutMotionLeavesAnOldOneAndTheCause) {
  drive(0, 10, true);
  model.set_why_standing(0, "the stamps of the two streams do not overlap: those of lidar are 34.0 s ahead");
  for (int second = 10; second < 20; ++second) {
    model.on_status(test::status_of("egocal-pairing", "pairing", second), at(second));
    model.tick(at(second));
  }
  expect_old("no new motion for 9");
  EXPECT_THAT(shown(Screen::overview), HasSubstr("the stamps of the two streams do not"));
  EXPECT_THAT(shown(Screen::overview), Not(HasSubstr("SILENT")));
}

// One sensor is silent, and pairing repeats what it has: the header had counted such an answer as good.
TEST_F(AnswerAge, APairThatFindsNoMotionIsNotCountedAsGood) {
  drive(0, 10, true);
  model.set_why_standing(0, "camera sends nothing");
  const auto repeat_until = [&](int end) {
    for (int second = 10; second < end; ++second) {
      model.on_problem(problem, at(second));
      model.on_calibration(test::calibration_at(problem, false), at(second));
      judge(at(second));
      model.tick(at(second));
    }
  };
  repeat_until(12);
  expect_good();
  repeat_until(20);
  EXPECT_THAT(shown(Screen::overview), HasSubstr("? no motion"));
  EXPECT_THAT(shown(Screen::overview), HasSubstr("0 of 1 good"));
}

// Its age fell from 13 to 5 seconds when pairing ended.
TEST_F(AnswerAge, DoesNotFallWhenPairingEnds) {
  status_t pairing = test::status_of("egocal-pairing", "pairing", 0);
  model.on_status(pairing, at(0));
  drive(0, 10, true);
  for (int second = 10; second < 30; ++second) {
    model.on_problem(problem, at(second));
    model.on_calibration(test::calibration_at(problem, false), at(second));
    model.tick(at(second));
  }
  EXPECT_THAT(shown(Screen::overview), HasSubstr("motions   19 s"));
  pairing.state = "ended";
  model.on_status(pairing, at(30));
  for (int second = 30; second < 36; ++second) {
    model.on_calibration(test::calibration_at(problem, false), at(second));
    model.tick(at(second));
  }
  EXPECT_THAT(shown(Screen::overview), HasSubstr("ENDED"));
  EXPECT_THAT(shown(Screen::overview), HasSubstr("motions   25 s"));
}

TEST_F(AnswerAge, WhatIsExportedOfAnOldOneDoesNotStateItsVerdict) {
  drive(0, 10, true);
  EXPECT_EQ(extrinsic_of(model.pairs()[0])->verdict, "good");
  drive(10, 40, true, false);
  EXPECT_EQ(extrinsic_of(model.pairs()[0])->verdict, "");
  EXPECT_THAT(extrinsic_of(model.pairs()[0])->reason, HasSubstr("pairing is silent for 30"));
}

TEST_F(AnswerAge, AMonitorThatCameLaterKnowsNoProblemAndVerifiesNothing) {
  problem = test::problem_at("lidar", "camera", 100, 10);
  model.on_calibration(test::calibration_at(problem, false), at(0), false);
  judge(at(0));
  model.tick(at(0.5));
  EXPECT_THAT(shown(Screen::overview), HasSubstr("? not verified"));
  EXPECT_THAT(shown(Screen::overview), HasSubstr("0 of 1 good"));
}

TEST_F(AnswerAge, WithoutANetworkTheHeaderSaysSo) {
  drive(0, 1, true);
  view.network_error = "no route";
  EXPECT_THAT(shown(Screen::overview), HasSubstr("NO NETWORK"));
}

// Several people may watch.
TEST_F(AnswerAge, ASecondMonitorIsNoRestart) {
  status_t first{}, second{};
  first.name = second.name = "egocal-monitor";
  first.role = second.role = "monitor";
  first.state = second.state = "running";
  first.pid = 7;
  second.pid = 8;
  first.run = 1;
  second.run = 2;
  for (int i = 0; i < 3; ++i) {
    model.on_status(first, at(i));
    model.on_status(second, at(i + 0.5));
  }
  EXPECT_EQ(model.processes().size(), 2u);
  for (const Event& event : model.events()) EXPECT_THAT(event.text, HasSubstr("process is there"));
}

TEST_F(AnswerAge, AfterPairingHasEndedTheLastAnswerStays) {
  status_t pairing = test::status_of("egocal-pairing", "pairing", 0);
  model.on_status(pairing, at(0));
  drive(0, 5, true);
  pairing.state = "ended";
  model.on_status(pairing, at(5));
  for (int second = 6; second < 60; ++second) model.tick(at(second));
  for (const Screen screen : {Screen::overview, Screen::detail}) {
    EXPECT_THAT(shown(screen), HasSubstr("good"));
    EXPECT_THAT(shown(screen), Not(HasSubstr("old answer")));
    EXPECT_THAT(shown(screen), HasSubstr("ENDED"));
  }
  EXPECT_THAT(shown(Screen::overview), HasSubstr("pairing has ended, this is its last answer"));

  // another one that hangs
  pairing.name = "egocal-pairing-2";
  pairing.state = "running";
  model.on_status(pairing, at(60));
  model.tick(at(61));
  expect_old("pairing is silent");
}

TEST_F(AnswerAge, ProcessesThatHaveEndedHaveNoRates) {
  status_t player;
  for (int second = 0; second < 5; ++second) {
    player = test::status_of("egocal-player", "player", 600 * second);
    model.on_status(player, at(second));
  }
  EXPECT_THAT(shown(Screen::overview), HasSubstr("600/s"));
  player.state = "ended";
  model.on_status(player, at(5));
  EXPECT_THAT(shown(Screen::overview), Not(HasSubstr("600/s")));
}

}  // namespace
}  // namespace egocal::monitor::test_age
