// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal-diagnosis on a virtual network in virtual time, with a pairing that is made of the library's parts.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/diagnosing.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "support/mistakes.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services {

using namespace std::chrono_literals;

inline testing::Streams drive(int poses, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.seed = seed;
  testing::Streams streams = testing::simulated_drive(options);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  return streams;
}

class DiagnosisService : public ::testing::Test {
 protected:
  DiagnosisService() {
    rig.sensors = {{"left", "ODO_LEFT", bus::OdometryType::odometry, {}},
                   {"right", "ODO_RIGHT", bus::OdometryType::odometry, {}}};
    rig.pairs.resize(1);
    rig.pairs[0].a = "left";
    rig.pairs[0].b = "right";
    observer.subscribe<verdict_t>(bus::verdict_channel("left", "right"),
                                  [this](const verdict_t& message, const bus::Arrival&) {
                                    EXPECT_TRUE(bus::to_verdict(message)) << bus::to_verdict(message).reason;
                                    verdicts.push_back(message);
                                  });
    observer.subscribe<status_t>(bus::status_channel,
                                 [this](const status_t& message, const bus::Arrival&) { status = message; });
  }

  void start() {
    heartbeat = std::make_unique<bus::Heartbeat>(
        loop, bus::Identity{"egocal-diagnosis", bus::Role::diagnosis, "1", 1}, 3s);
    service = std::make_unique<Diagnosing>(loop, *heartbeat, rig, nullptr, options);
  }
  /// For long drives of which only the end is looked at; the problems must be as seldom.
  void diagnose_every_ten_seconds() { options.pose_step = 10; }
  void pass(std::chrono::nanoseconds time) { test::run_for(clock, {&observer, &loop}, time); }

  /// One pose of each stream, to the service and to the test's own pairing.
  void send_poses(const testing::Streams& streams, std::size_t i, MotionPairing& pairing) {
    for (const Side side : {Side::a, Side::b}) {
      const StampedPose& pose = (side == Side::a ? streams.a : streams.b)[i];
      observer.publish(side == Side::a ? "ODO_LEFT" : "ODO_RIGHT",
                       bus::to_message(pose, ++seq[side == Side::a]));
      problems += static_cast<std::int64_t>(pairing.push(side, pose).size());
    }
    pass(100ms);
  }

  /// Plays poses [begin, end) in real time, with the problem of pairing after each `every` poses.
  void play(const testing::Streams& streams, std::size_t begin, std::size_t end, std::size_t every = 40) {
    MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
    const std::int64_t session = streams.a[begin].time_us;
    for (std::size_t i = begin; i < end; ++i) {
      send_poses(streams, i, pairing);
      if ((i % every != every - 1 && i + 1 != end) || problems == 0) continue;
      publish(pairing, session, streams.a[i].time_us, problems);
    }
    pass(2s);
    problems = 0;
  }

  /// The problem that pairing makes of poses [begin, end).
  void send_problem(const testing::Streams& streams, std::size_t begin, std::size_t end) {
    MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
    std::int64_t pairs = 0;
    for (std::size_t i = begin; i < end; ++i)
      for (const Side side : {Side::a, Side::b})
        pairs += static_cast<std::int64_t>(
            pairing.push(side, (side == Side::a ? streams.a : streams.b)[i]).size());
    publish(pairing, streams.a[begin].time_us, streams.a[end - 1].time_us, pairs);
  }
  void publish(const MotionPairing& pairing, std::int64_t session, std::int64_t utime, std::int64_t number) {
    problem_t message = bus::to_message(pairing.problem());
    message.session = session;
    message.utime = utime;
    message.seq = number;
    message.sensor_a = "left";
    message.sensor_b = "right";
    message.stride = pairing.choice().stride;
    message.time_offset = pairing.time_offset().value_or(0);
    message.matched = static_cast<std::int64_t>(pairing.counts().matched);
    observer.publish(bus::problem_channel("left", "right"), message);
    sent = message;
  }

  void tell(const std::string& verb) {
    command_t command{};
    command.to = "*";
    command.verb = verb;
    observer.publish(bus::command_channel, command);
    pass(200ms);
  }

  test::VirtualClock clock;
  test::VirtualNetwork network{clock};
  bus::Loop observer{network.transport(), clock, {.handle_signals = false, .host = "car"}};
  bus::Loop loop{network.transport(), clock, {.handle_signals = false, .host = "car"}};
  bus::Rig rig;
  DiagnosingOptions options;
  std::unique_ptr<bus::Heartbeat> heartbeat;
  std::unique_ptr<Diagnosing> service;
  std::vector<verdict_t> verdicts;
  status_t status;
  std::int64_t problems = 0;
  problem_t sent{};  ///< the newest
  std::int64_t seq[2]{};
};

}  // namespace egocal::services
