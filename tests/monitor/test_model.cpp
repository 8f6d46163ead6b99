// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages in, plain data out: every event, but those of hostile senders (test_hostile).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
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

}  // namespace

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

TEST(ModelEvents, ProcessGoneBackRestartedEnded) {
  PairDrive drive;
  status_t status = status_of("egocal-fast", "fast", 1);
  drive.heartbeat(status);
  drive.run(20);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  drive.run(20);
  EXPECT_FALSE(drive.model.processes()[0].alive);
  drive.heartbeat(status);
  status.run = 2;
  drive.heartbeat(status);
  status.state = "paused";
  status.last_error = "no global solver";
  drive.heartbeat(status);
  status.state = "ended";
  drive.heartbeat(status);
  EXPECT_FALSE(drive.model.processes()[0].alive);
  drive.run(50);
  std::vector<std::string> about;
  for (const std::string& text : drive.texts())
    if (text.starts_with("egocal-fast: ")) about.push_back(text.substr(13));
  EXPECT_THAT(about, ElementsAre("process is there (running)", "process is gone: no heartbeat for 3 s",
                                 "process is back", "process was restarted", "changed from running to paused",
                                 "no global solver", "changed from paused to ended"));
}

// A diagnosis of a drive that contradicts itself, on a core that others take, may compute for longer than 3
// s.
TEST(ModelEvents, AProcessThatComputesAsItHasAnnouncedIsNotGone) {
  PairDrive drive;
  status_t status = status_of("egocal-diagnosis", "diagnosis", 1);
  drive.heartbeat(status);
  counter_t& announced = status.counters.emplace_back();
  announced.name = bus::announced_silence_counter;
  announced.value = 20;
  status.n_counters = static_cast<std::int32_t>(status.counters.size());
  drive.heartbeat(status);
  drive.run(20);
  EXPECT_FALSE(drive.model.processes()[0].computes) << "others are silent for so long, too";
  drive.run(100);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  EXPECT_TRUE(drive.model.processes()[0].computes);
  EXPECT_THAT(text_lines(drive.model, Charset::ascii), HasSubstr("egocal-diagnosis: computes, pid"));
  drive.run(100);
  EXPECT_FALSE(drive.model.processes()[0].alive) << "it was silent for longer than it has announced";
  EXPECT_FALSE(drive.model.processes()[0].computes);
  EXPECT_THAT(drive.texts(), Contains("egocal-diagnosis: process is gone: no heartbeat for 20 s"));
  drive.heartbeat(status);
  status.counters.pop_back();
  status.n_counters = static_cast<std::int32_t>(status.counters.size());
  drive.heartbeat(status);
  drive.run(40);
  EXPECT_FALSE(drive.model.processes()[0].alive) << "its computation was over";
}

// A clock that is set back between a death and the restart gives the new run the smaller number.
TEST(ModelEvents, ASecondProcessIsOneThatIsHeardBesideTheFirst) {
  PairDrive drive;
  status_t first = status_of("egocal-fast", "fast", 1), second = first;
  first.run = 100;
  second.run = 50;
  second.pid = first.pid + 1;
  drive.heartbeat(first);
  drive.heartbeat(second);
  drive.heartbeat(second);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("egocal-fast: process is there (running)", "egocal-fast: process was restarted"));
  drive.heartbeat(first);
  EXPECT_THAT(drive.fresh(), ElementsAre("egocal-fast: a second process of this name is running"));
}

TEST(ModelEvents, ThisProcessIsThereWithoutANetwork) {
  PairDrive drive;
  ModelOptions options;
  options.own_host = "car";
  options.own_pid = 7;
  drive.model = Model(options);
  status_t own = status_of("egocal-monitor", "monitor", 1), other = own;
  own.host = other.host = "car";
  own.pid = 7;
  other.pid = 8;
  drive.heartbeat(own);
  drive.heartbeat(other);
  drive.run(40);
  ASSERT_EQ(drive.model.processes().size(), 2u);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  EXPECT_EQ(drive.model.processes()[0].at.mono_us, drive.model.now().mono_us);
  EXPECT_FALSE(drive.model.processes()[1].alive);
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

TEST(ModelEvents, ManyMotionsThatContradictTheOthers) {
  PairDrive drive;
  drive.change_problem = [](problem_t& p) { p.left_out = p.matched / 30; };
  drive.run(100);
  EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("contradict"))));
  drive.fresh();
  drive.change_problem = [](problem_t& p) {
    p.matched = 90;
    p.left_out = 10;
  };
  drive.run(50);
  EXPECT_THAT(
      drive.fresh(),
      ElementsAre("lidar -> camera: 10 % of the motions contradict the others and are rejected as outliers"));
  drive.change_problem = [](problem_t& p) { p.left_out = p.matched = 100; };
  drive.run(50);
  EXPECT_THAT(
      drive.fresh(),
      ElementsAre("lidar -> camera: 50 % of the motions contradict the others and are rejected as outliers"));
}

TEST(ModelEvents, GapInAStreamAndSilence) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  drive.step += 12;  // twelve problems were skipped, as under a flood: their motions are in the next one
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre());
  EXPECT_EQ(drive.pair().gap_count, 0);
  drive.step += 12;  // 1.2 s are missing, and no motion is in them
  drive.change_problem = [](problem_t& p) { p.seq -= 12; };
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: gap of 1.3 s in the stream"));
  EXPECT_EQ(drive.pair().gap_count, 1);
  // as many steps as one motion spans are no gap
  drive.change_problem = [](problem_t& p) {
    p.stride = 4;
    p.seq -= 27;
  };
  drive.step += 15;
  drive.run(1);
  EXPECT_EQ(drive.pair().gap_count, 1);
  drive.fresh();
  drive.step += 21;
  drive.model.tick(drive.now());
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: the stream is silent: no new motion for 2 s"));
  drive.run(1);
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: the stream is back"));
}

TEST(ModelEvents, NoNewMotionThoughPairingLives) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  const std::int64_t newest = drive.pair().problem.seq;
  drive.change_problem = [&](problem_t& p) { p.seq = newest; };  // sent again and again
  drive.run(60);
  EXPECT_NEAR(drive.pair().standing, 6, 0.2);
  EXPECT_THAT(drive.fresh(), ElementsAre()) << "a log has ended, or nothing is known of the streams";
  drive.model.set_why_standing(0, "camera sends nothing");
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: no new motion for 6 s: camera sends nothing"));
  drive.run(20);
  EXPECT_THAT(drive.fresh(), ElementsAre());
  drive.change_problem = [](problem_t&) {};
  drive.run(1);
  EXPECT_EQ(drive.pair().standing, 0);
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: new motions come again"));
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

TEST(ModelPause, KnownByCommandsByStatesAndByMotionsThatGoOn) {
  PairDrive drive;
  drive.run(5);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair()));
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  command.sensor_a = "lidar";
  command.sensor_b = "other";
  drive.model.on_command(command, drive.now());
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "that was another pair";
  command.sensor_b = "camera";
  command.to = "egocal-player";
  drive.model.on_command(command, drive.now());
  status_t player = status_of("egocal-player", "player", 1);
  player.state = "paused";
  drive.heartbeat(player);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "the player rests, the calibration does not";
  command.to = "*";
  drive.model.on_command(command, drive.now());
  // problems are repeated while paused, without new motions and without answers
  drive.change_problem = [](problem_t& p) { p.seq = 5; };
  drive.fast = false;
  drive.run(40);
  EXPECT_TRUE(pair_is_paused(drive.model, drive.pair()));
  EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("no longer answers"))));
  drive.fast = true;
  drive.change_problem = [](problem_t&) {};
  drive.run(1);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "it was resumed by a message that was lost";
  status_t status = status_of("egocal-pairing", "pairing", 1);
  status.state = "paused";
  drive.heartbeat(status);
  EXPECT_TRUE(pair_is_paused(drive.model, drive.pair()));

  ViewState view;
  press(view, drive.model, {Key::character, 'p'});
  EXPECT_EQ(view.dialog, Dialog::resume);
  EXPECT_EQ(press(view, drive.model, {Key::character, 'y'}).kind, Action::Kind::resume);
}

TEST(ModelProcesses, CountsAndRates) {
  PairDrive drive;
  status_t status = status_of("egocal-pairing", "pairing", 100);
  const auto count = [&](const char* name, std::int64_t value) {
    counter_t& counter = status.counters.emplace_back();
    counter.name = name;
    counter.value = value;
  };
  count("lost", 3);
  count("rejected: too late", 4);
  count("rejected: duplicate", 5);
  drive.heartbeat(status);
  const ProcessState& process = drive.model.processes()[0];
  EXPECT_EQ(process.lost, 3);
  EXPECT_EQ(process.rejected, 9);
  EXPECT_LT(process.rate_in, 0) << "not known yet";
  drive.step += 10;
  status.counters[0].value = 300;
  drive.heartbeat(status);
  EXPECT_NEAR(process.rate_in, 200, 1e-9);
  status.run = 2;  // restarted: counts begin at zero
  status.counters[0].value = 5;
  drive.step += 10;
  drive.heartbeat(status);
  EXPECT_LT(process.rate_in, 0);
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

}  // namespace egocal::monitor::test_model
