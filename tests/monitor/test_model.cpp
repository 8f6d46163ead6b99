// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages in, plain data out: every event, but those of processes (test_model_processes), of missing motions
// (test_model_motions) and of hostile senders (test_hostile).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstddef>
#include <string>

#include "egocal/monitor/model.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_model {
namespace {

using test::begin_utime;
using test::calibration_at;
using test::PairDrive;
using test::problem_at;
using test::status_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(ModelEvents, FallbackCertificateAndTheFastSolverAlone) {
  PairDrive drive;
  drive.global = true;
  drive.run(5);
  EXPECT_THAT(drive.texts(),
              ElementsAre("lidar -> camera: optimal (proven), by egocal-global",
                          "lidar -> camera: solver added: egocal-fast (sqp) answers as well",
                          "lidar -> camera: egocal-fast starts from answers of the global solver"));
  for (const Event& event : drive.model.events()) EXPECT_LT(event.severity, Severity::warning) << event.text;
  EXPECT_FALSE(drive.pair().only_fast_since);
  drive.run(35);
  drive.global = false;
  drive.run(20);
  ASSERT_TRUE(drive.pair().only_fast_since);
  EXPECT_NEAR(*drive.pair().only_fast_since, 3.9, 1e-6) << "right after the global one's last answer";
  EXPECT_EQ(drive.pair().counted_solver()->name, "egocal-fast");
  // the first fallback of a session has ended more than a second ago: said once, when it was over
  EXPECT_THAT(drive.texts(), Contains("lidar -> camera: only the fast solver runs").Times(1));

  drive.fresh();
  drive.change_answer = [](calibration_t& answer) { answer.fallback = 1; };
  drive.run(1);
  EXPECT_FALSE(drive.pair().only_fast_since);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("lidar -> camera: fallback: egocal-fast asked for the global solver"));
  EXPECT_EQ(drive.model.events().back().severity, Severity::warning);
  drive.change_answer = [](calibration_t&) {};
  drive.run(15);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: only the fast solver runs again"));
}

// It solves globally itself until it knows of the global solver, and then asks that one.
TEST(ModelEvents, AFastSolverThatStartsOrIsRestartedIsNoSwapAndNoFallback) {
  PairDrive drive;
  drive.heartbeat(status_of("egocal-fast", "fast", 1));
  const auto start = [&] {
    drive.change_answer = [](calibration_t& answer) { answer.method = "dual"; };
    drive.run(3);
    drive.change_answer = [](calibration_t& answer) {
      answer.method = "sqp";
      answer.fallback = 1;
    };
    drive.run(3);
    drive.change_answer = [](calibration_t&) {};
    drive.run(20);
    for (const Event& event : drive.model.events())
      EXPECT_LT(event.severity, Severity::warning) << event.text;
    EXPECT_THAT(drive.fresh(), Not(Contains(HasSubstr("swapped"))));
  };
  start();
  status_t restarted = status_of("egocal-fast", "fast", 1);
  restarted.run = 2;
  drive.heartbeat(restarted);
  start();
}

TEST(ModelEvents, CertificateLostAndFoundButNotForAMoment) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  drive.change_answer = [](calibration_t& answer) { answer.status = 1; };
  drive.run(5);
  EXPECT_THAT(drive.fresh(), IsEmpty()) << "half a second is no event";
  drive.run(20);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: proof lost: a better answer is known"));
  drive.change_answer = [](calibration_t&) {};
  drive.run(5);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: optimal (proven), by egocal-fast"));
  drive.change_answer = [](calibration_t& answer) { answer.status = 2; };
  drive.run(20);
  EXPECT_THAT(drive.texts(), Contains("lidar -> camera: proof lost: too imprecise to decide"));
}

TEST(ModelEvents, SolverSwapped) {
  PairDrive drive;
  drive.run(20);
  drive.fresh();
  drive.change_answer = [](calibration_t& answer) { answer.method = "sdp"; };
  drive.run(1);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("lidar -> camera: solver swapped: egocal-fast changed from sqp to sdp"));
  drive.change_answer = [](calibration_t& answer) {
    answer.solver = "egocal-other-fast";
    answer.method = "sdp";
  };
  drive.run(1);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("lidar -> camera: solver added: egocal-other-fast (sdp) answers as well"));
  drive.run(30);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: solver swapped: egocal-fast no longer answers"));
  drive.change_answer = [](calibration_t& answer) { answer.method = "sdp"; };
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: egocal-fast answers again"));
}

TEST(ModelEvents, ManySolversOfOneSessionAreBounded) {
  PairDrive drive;
  drive.change_answer = [&](calibration_t& answer) {
    answer.solver = "solver-" + std::to_string(answer.seq);
  };
  drive.run(500);
  EXPECT_EQ(drive.pair().solvers.size(), Model::max_solvers);
  EXPECT_EQ(drive.pair().counted_solver()->name, "solver-500");
}

TEST(ModelEvents, StrideChosenAnewOrAddedUp) {
  PairDrive drive;
  drive.run(10);
  drive.fresh();
  const auto choose = [&](int stride, const std::string& why) {
    drive.change_problem = [=](problem_t& p) {
      p.stride = stride;
      p.choice = why;
    };
    drive.run(1);
    return drive.fresh();
  };
  const std::string sum = "sum over strides, 1.1 steps in the mean, weighted by the residuals";
  EXPECT_THAT(choose(16, "smallest spread"),
              ElementsAre("lidar -> camera: stride is now 16 (smallest spread)"));
  // the best single stride stays 16, and is not in force
  EXPECT_THAT(choose(16, sum), ElementsAre("lidar -> camera: the motions are now a " + sum));
  EXPECT_THAT(choose(4, sum), IsEmpty());
  EXPECT_THAT(choose(4, "smallest spread"),
              ElementsAre("lidar -> camera: stride is now 4 (smallest spread)"));
}

TEST(ModelEvents, SessionResetForgetsTheOldOne) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  const auto anew = [](auto& message) {
    message.session = begin_utime + 3'000'000;
    message.seq -= 30;
  };
  drive.change_problem = anew;
  drive.fast = false;
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: session reset: the calibration starts again"));
  EXPECT_EQ(drive.pair().answer(), nullptr);
  // an answer of the session before is late
  drive.model.on_calibration(calibration_at(problem_at("lidar", "camera", 29, 10), false), drive.now());
  EXPECT_EQ(drive.pair().answer(), nullptr);
  drive.fast = true;
  drive.run(1);
  ASSERT_NE(drive.pair().answer(), nullptr);
  EXPECT_NEAR(drive.pair().solvers[0].history.last_time(), 0.1, 1e-9) << "its time begins anew";
}

TEST(ModelEvents, TimeOffsetChangedBeyondItsNoise) {
  PairDrive drive;
  drive.change_problem = [](problem_t& p) {
    p.time_offset = 0.020;
    p.time_offset_stddev = 0.002;
  };
  drive.run(10);
  drive.change_problem = [](problem_t& p) {
    p.time_offset = 0.024;
    p.time_offset_stddev = 0.002;
  };
  drive.run(10);
  EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("time offset"))));
  drive.change_problem = [](problem_t& p) {
    p.time_offset = 0.0352;
    p.time_offset_stddev = 0.002;
  };
  drive.run(10);
  EXPECT_THAT(drive.texts(), Contains("lidar -> camera: time offset changed from 20.0 to 35.2 ms").Times(1));
}

TEST(ModelEvents, TheSameAgainIsCounted) {
  PairDrive drive;
  for (int i = 0; i < 5; ++i)
    drive.model.note(Severity::warning, "stderr", std::string(500, 'x'), drive.now());
  ASSERT_EQ(drive.model.events().size(), 1u);
  EXPECT_EQ(drive.model.events()[0].repeated, 5);
  EXPECT_EQ(drive.model.events()[0].text.size(), Model::max_text);
  drive.step += 400;
  drive.model.note(Severity::warning, "stderr", std::string(500, 'x'), drive.now());
  EXPECT_EQ(drive.model.events().size(), 2u) << "after a while it is news again";
}

TEST(ModelEvents, CommandsOfAnybody) {
  PairDrive drive;
  drive.run(1);
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  command.sensor_a = "lidar";
  command.sensor_b = "camera";
  drive.model.on_command(command, drive.now());
  EXPECT_THAT(drive.texts(), Contains("lidar -> camera: command: pause"));
  EXPECT_TRUE(pair_is_paused(drive.model, drive.pair()));
}

TEST(Memory, FlatOverASimulatedDay) {
  PairDrive drive;
  drive.global = true;
  drive.model.on_status(status_of("egocal-fast", "fast", 1), drive.now());
  const auto hours = [&](int n) {
    for (int minute = 0; minute < 60 * n; ++minute) {
      drive.run(60);
      drive.step += 540;  // a day of ten messages a second, a tenth of them sent
      drive.heartbeat(status_of("egocal-fast", "fast", drive.step));
      if (minute % 7 == 0) drive.model.note(Severity::info, "x", std::to_string(drive.step), drive.now());
    }
  };
  hours(8);
  const std::size_t before = mallinfo2().uordblks;
  hours(16);
  const std::size_t after = mallinfo2().uordblks;
  EXPECT_NEAR(static_cast<double>(drive.step) / 36000, 24, 0.01);
  EXPECT_LE(after, before + 256 * 1024) << "bytes in use, 8 h and 24 h into the day";
  EXPECT_EQ(drive.model.events().size(), Model::max_events);
  for (const SolverTrack& solver : drive.pair().solvers)
    for (double back : {0.0, 100.0, 1000.0, 40000.0, 86400.0})
      EXPECT_LE(solver.history.since(solver.history.last_time() - back).size(), History::slices);
}

}  // namespace
}  // namespace egocal::monitor::test_model
