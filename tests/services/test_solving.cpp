// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Both solvers, in one process, on a virtual network in virtual time: no socket, no waiting.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/simulation/simulation.hpp"
#include "solving/fast.hpp"
#include "solving/global.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_solving {
namespace {

using namespace std::chrono_literals;

/// One process: its loop and its heartbeat.
struct Host {
  Host(test::VirtualNetwork& network, const bus::Clock& clock, bus::Identity identity)
      : loop(network.transport(), clock, {.handle_signals = false, .host = "car"}),
        heartbeat(loop, std::move(identity), 3s) {}
  bus::Loop loop;
  bus::Heartbeat heartbeat;
};

class Solving : public ::testing::Test {
 protected:
  Solving() {
    rig.pairs.resize(1);
    rig.pairs[0].a = "left";
    rig.pairs[0].b = "right";
    observer.subscribe<calibration_t>(
        bus::calibration_channel("left", "right"),
        [this](const calibration_t& message, const bus::Arrival&) { answers[message.solver] = message; });
    rig.sensors = {{"left", "ODO_LEFT", bus::OdometryType::odometry, {}},
                   {"right", "ODO_RIGHT", bus::OdometryType::odometry, {}, 1, true}};
    observer.subscribe<scale_t>(
        bus::scale_channel("left", "right"),
        [this](const scale_t& message, const bus::Arrival&) { scales.push_back(message); });
    observer.subscribe<status_t>(bus::status_channel, [this](const status_t& message, const bus::Arrival&) {
      statuses[message.name] = message;
    });
    SimulationOptions options;
    options.terrain = Terrain::free;
    options.poses = 60;
    options.relative_noise = 0.01;
    options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
    const std::vector<Trajectory> drive = simulate(options);
    Statistics statistics;
    for (std::size_t i = 1; i < drive[0].size(); ++i) {
      MotionPair& motion = motions.emplace_back();
      motion.a = conjugate(drive[0][i - 1].pose) * drive[0][i].pose;
      motion.b = conjugate(drive[1][i - 1].pose) * drive[1][i].pose;
      statistics.add(motion.a, motion.b);
    }
    problem.blocks = {statistics};
  }

  void send(std::int64_t seq, double time_s) {
    problem_t message = bus::to_message(problem);
    message.session = 1'600'000'000'000'000;
    message.utime = message.session + static_cast<std::int64_t>(1e6 * time_s);
    message.seq = seq;
    message.sensor_a = "left";
    message.sensor_b = "right";
    message.host = "car";
    message.received_mono_us = observer.mono_us();
    observer.publish(bus::problem_channel("left", "right"), message);
  }
  void pass(std::chrono::nanoseconds time) {
    std::vector<bus::Loop*> loops{&observer};
    if (fast_host) loops.push_back(&fast_host->loop);
    if (global_host) loops.push_back(&global_host->loop);
    test::run_for(clock, loops, time);
  }
  /// The same motions of one second, those of the right sensor in another unit.
  void send_scale(std::int64_t seq, double factor) {
    ScaleProblem scale;
    scale.options.side = Side::b;
    scale.blocks = scale_blocks(motions);
    for (ScaleStatistics& block : scale.blocks) {  // lengths of b divided by the factor
      block.coupling_b /= factor;
      block.cross /= factor;
      block.square_b /= factor * factor;
    }
    scale_problem_t message = bus::to_message(scale);
    message.session = message.utime = 1'600'000'000'000'000;
    message.seq = seq;
    message.sensor_a = "left";
    message.sensor_b = "right";
    observer.publish(bus::scale_problem_channel("left", "right"), message);
  }
  void start_fast() {
    fast_host =
        std::make_unique<Host>(network, clock, bus::Identity{"egocal-fast", bus::Role::fast, "1", 100});
    fast = std::make_unique<FastSolver>(fast_host->loop, fast_host->heartbeat, rig, Method::sqp);
  }
  void start_global() {
    global_host =
        std::make_unique<Host>(network, clock, bus::Identity{"egocal-global", bus::Role::global, "1", 200});
    global =
        std::make_unique<GlobalSolver>(global_host->loop, global_host->heartbeat, rig, Method::dual, false);
  }

  test::VirtualClock clock;
  test::VirtualNetwork network{clock};
  bus::Loop observer{network.transport(), clock, {.handle_signals = false, .host = "car"}};
  bus::Rig rig;
  Problem problem;
  std::vector<MotionPair> motions;
  std::map<std::string, calibration_t> answers;
  std::vector<scale_t> scales;
  std::map<std::string, status_t> statuses;
  std::unique_ptr<Host> fast_host, global_host;
  std::unique_ptr<FastSolver> fast;
  std::unique_ptr<GlobalSolver> global;
};

TEST_F(Solving, TheGlobalSolverAnswersTheScaleAndTheFastOneStepsIn) {
  start_fast();
  start_global();
  pass(5s);
  send_scale(5, 0.37);
  pass(100ms);
  ASSERT_EQ(scales.size(), 1u);
  EXPECT_EQ(scales[0].solver, "egocal-global");
  EXPECT_NEAR(scales[0].scale, 0.37, 0.02);
  EXPECT_EQ(scales[0].side, 1);
  EXPECT_TRUE(scales[0].certified);
  EXPECT_TRUE(scales[0].observable);
  EXPECT_GT(scales[0].stddev, 0);
  send_scale(5, 0.37);  // again, as pairing does every second
  pass(100ms);
  ASSERT_EQ(scales.size(), 2u);
  EXPECT_EQ(bus::encode(scales[1]), bus::encode(scales[0]));
  global.reset();
  global_host.reset();
  pass(5s);
  send_scale(6, 2.7);
  pass(100ms);
  ASSERT_FALSE(scales.empty());
  EXPECT_EQ(scales.back().solver, "egocal-fast");
  EXPECT_EQ(scales.back().seq, 6);
  EXPECT_NEAR(scales.back().scale, 2.7, 0.15);
}

TEST_F(Solving, AnswersComeAgainWhilePairingIsSilent) {
  start_fast();
  start_global();
  pass(5s);
  send_scale(5, 0.37);
  send(1, 1);
  pass(1s);
  ASSERT_EQ(answers["egocal-fast"].seq, 1);
  const calibration_t before = answers["egocal-fast"];
  pass(60s);
  answers.clear();
  scales.clear();
  pass(1100ms);
  ASSERT_TRUE(answers.contains("egocal-fast"));
  EXPECT_EQ(answers["egocal-fast"].seq, 1);
  EXPECT_EQ(answers["egocal-fast"].cost, before.cost);
  EXPECT_EQ(scales.size(), 1u) << "the global solver's; the fast one leaves it to that";
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  observer.publish(bus::command_channel, command);
  pass(100ms);
  answers.clear();
  pass(5s);
  EXPECT_TRUE(answers.empty()) << "a paused solver sends nothing";
}

TEST_F(Solving, StandardDeviationsContainThatOfTheScale) {
  problem.blocks.assign(10, {});
  for (std::size_t i = 0; i < motions.size(); ++i)
    problem.blocks[i * 10 / motions.size()].add(motions[i].a, motions[i].b);
  start_fast();
  pass(5s);
  send(1, 1);
  pass(100ms);
  const calibration_t before = answers["egocal-fast"];
  send_scale(5, 0.37);
  send(2, 2);
  pass(100ms);
  const calibration_t after = answers["egocal-fast"];
  ASSERT_EQ(after.seq, 2);
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(std::isfinite(before.stddev[i])) << i;
    EXPECT_GE(after.stddev[i], before.stddev[i]) << i;
    EXPECT_LT(after.stddev[i], 3 * before.stddev[i]) << i;
    if (i < 3) {
      EXPECT_GT(after.stddev[i], before.stddev[i]) << i;
    }
  }
}

TEST_F(Solving, RightAfterTheStartNoSolverIsMissed) {
  start_fast();
  start_global();
  pass(10s);
  for (const char* name : {"egocal-fast", "egocal-global"}) EXPECT_EQ(statuses[name].last_error, "") << name;
  EXPECT_EQ(statuses["egocal-fast"].state, "running");
  EXPECT_EQ(statuses["egocal-global"].state, "standby");
}

TEST_F(Solving, AfterTheNetworkWasAwayNoSolverIsMissed) {
  start_fast();
  start_global();
  pass(10s);
  network.set_away(true);
  pass(60s);
  network.set_away(false);
  for (int i = 0; i < 100; ++i) {
    pass(100ms);
    for (const char* name : {"egocal-fast", "egocal-global"})
      EXPECT_THAT(statuses[name].last_error, ::testing::Not(::testing::HasSubstr("solver is alive"))) << name;
  }
}

TEST_F(Solving, AMissingSolverIsReportedAfterTheTimeoutOnly) {
  start_fast();
  pass(2900ms);
  EXPECT_EQ(statuses["egocal-fast"].last_error, "");
  pass(2s);
  EXPECT_THAT(statuses["egocal-fast"].last_error, ::testing::HasSubstr("no global solver is alive"));
}

TEST_F(Solving, TheGlobalSolverAnswersUntilTheFastOneIsVerifiedAndStepsInWhenItEnds) {
  start_fast();
  start_global();
  pass(1s);
  std::int64_t seq = 0;
  for (; seq < 100; ++seq) {  // ten seconds of data: the fast solver asks for the first five
    send(seq, 0.1 * static_cast<double>(seq));
    pass(100ms);
    ASSERT_EQ(answers["egocal-fast"].seq, seq);
    EXPECT_EQ(answers["egocal-fast"].status, 0);
  }
  const std::int64_t last_global = answers["egocal-global"].seq;
  EXPECT_GT(last_global, 40);
  EXPECT_LT(last_global, 60);
  EXPECT_EQ(answers["egocal-fast"].latency_us, 0) << "virtual time does not advance while messages travel";

  fast_host->heartbeat.end();
  fast.reset();
  fast_host.reset();
  send(seq, 10);
  pass(1500ms);
  EXPECT_EQ(answers["egocal-global"].seq, seq);
  EXPECT_EQ(statuses["egocal-global"].state, "running");
}

TEST_F(Solving, AResetMeansTheNewestSessionAlsoWhereNothingWasAnswered) {
  start_fast();
  start_global();
  for (int seq = 0; seq < 100; ++seq) {
    send(seq, 0.1 * seq);
    pass(100ms);
  }
  command_t command{};
  command.to = "*";
  command.verb = "reset";
  command.session = 1'600'000'000'000'000;
  observer.publish(bus::command_channel, command);
  pass(2s);
  for (const char* name : {"egocal-fast", "egocal-global"})
    for (const counter_t& counter : statuses[name].counters)
      EXPECT_NE(counter.name, "rejected: " + not_meant);
}

}  // namespace
}  // namespace egocal::services::test_solving
