// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal-diagnosis that is killed and continues from its state, in virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "diagnosis/diagnosing.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "support/mistakes.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

testing::Streams drive(int poses) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = 0.01;
  testing::Streams streams = testing::simulated_drive(options);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  return streams;
}

/// One process of several, each with the state that the one before left on the disk.
struct Host {
  Host(test::VirtualNetwork& network, const bus::Clock& clock, const bus::Rig& rig, const std::string& state)
      : loop(network.transport(), clock, {.handle_signals = false}),
        heartbeat(loop, bus::Identity{"egocal-diagnosis", bus::Role::diagnosis, "1", 1}, 3s),
        service(loop, heartbeat, rig, state.empty() ? nullptr : std::make_unique<SavedMemory>(state, rig)) {}
  bus::Loop loop;
  bus::Heartbeat heartbeat;
  Diagnosing service;
};

class SavedMemories : public ::testing::Test {
 protected:
  SavedMemories() {
    char name[] = "/tmp/egocal-memory-XXXXXX";
    folder = mkdtemp(name);
    file = folder + "/diagnosis.state";
    rig.sensors = {{"left", "ODO_LEFT", bus::OdometryType::odometry, {}},
                   {"right", "ODO_RIGHT", bus::OdometryType::odometry, {}}};
    rig.pairs.resize(1);
    rig.pairs[0].a = "left";
    rig.pairs[0].b = "right";
    pairing = std::make_unique<MotionPairing>(bus::drive_options(rig, rig.pairs[0]));
    observer.subscribe<verdict_t>(
        bus::verdict_channel("left", "right"),
        [this](const verdict_t& message, const bus::Arrival&) { verdicts.push_back(message); });
    observer.subscribe<status_t>(bus::status_channel,
                                 [this](const status_t& message, const bus::Arrival&) { status = message; });
  }
  ~SavedMemories() override {
    host.reset();
    std::filesystem::remove_all(folder);
  }

  void start() { host = std::make_unique<Host>(network, clock, rig, file); }
  /// As by SIGKILL: what the destructor writes is undone.
  void kill() {
    std::filesystem::copy_file(file, folder + "/kept");
    host.reset();
    std::filesystem::rename(folder + "/kept", file);
    verdicts.clear();
  }
  void pass(std::chrono::nanoseconds time) {
    std::vector<bus::Loop*> loops{&observer};
    if (host) loops.push_back(&host->loop);
    test::run_for(clock, loops, time);
  }
  /// Poses until end, as live sensors and pairing send them.
  void play(const testing::Streams& streams, std::size_t end) {
    for (; next < end; ++next) {
      for (const Side side : {Side::a, Side::b}) {
        const StampedPose& pose = (side == Side::a ? streams.a : streams.b)[next];
        observer.publish(side == Side::a ? "ODO_LEFT" : "ODO_RIGHT",
                         bus::to_message(pose, static_cast<std::int64_t>(next)));
        motions += static_cast<std::int64_t>(pairing->push(side, pose).size());
      }
      pass(100ms);
      if (next % 10 != 9) continue;
      problem = bus::to_message(pairing->problem());
      problem.session = streams.a[0].time_us;
      problem.utime = streams.a[next].time_us;
      problem.seq = motions;
      problem.sensor_a = "left";
      problem.sensor_b = "right";
      problem.stride = pairing->choice().stride;
      problem.matched = static_cast<std::int64_t>(pairing->counts().matched);
      send_problem();
    }
  }
  void send_problem() { observer.publish(bus::problem_channel("left", "right"), problem); }
  std::int64_t count(const std::string& name) const {
    for (const counter_t& counter : status.counters)
      if (counter.name == name) return counter.value;
    return 0;
  }

  std::string folder, file;
  test::VirtualClock clock;
  test::VirtualNetwork network{clock};
  bus::Loop observer{network.transport(), clock, {.handle_signals = false}};
  bus::Rig rig;
  std::unique_ptr<MotionPairing> pairing;
  std::unique_ptr<Host> host;
  std::size_t next = 0;
  std::int64_t motions = 0;
  problem_t problem{};
  std::vector<verdict_t> verdicts;
  status_t status{};
};

TEST_F(SavedMemories, TheVerdictIsWhatItWasWithinSeconds) {
  start();
  const testing::Streams streams = drive(500);
  play(streams, 400);
  pass(3s);
  ASSERT_FALSE(verdicts.empty());
  const verdict_t before = verdicts.back();
  ASSERT_EQ(before.verdict, "good") << before.reason;
  kill();
  start();
  send_problem();  // as pairing does once a second
  pass(2s);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
  EXPECT_EQ(verdicts.back().reason, before.reason);
  EXPECT_EQ(verdicts.back().utime_begin, before.utime_begin);
  EXPECT_EQ(count("restored"), 1);
  play(streams, 500);
  pass(2s);
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
  EXPECT_EQ(verdicts.back().utime_begin, before.utime_begin);
}

TEST_F(SavedMemories, WhatNoProcessHeardIsNotSeen) {
  start();
  const testing::Streams streams = drive(900);
  play(streams, 300);
  pass(3s);
  kill();
  play(streams, 600);  // half of the drive
  start();
  play(streams, 650);
  pass(2s);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "incomplete") << verdicts.back().reason;
  EXPECT_THAT(verdicts.back().reason, HasSubstr("30 s are not judged"));
  kill();
  start();
  send_problem();
  pass(2s);
  EXPECT_EQ(verdicts.back().verdict, "incomplete") << "what was missed is remembered, too";
}

TEST_F(SavedMemories, OfAnotherSessionAreNotUsed) {
  start();
  play(drive(400), 400);
  pass(3s);
  kill();
  start();
  problem.session += 39'000'000;
  problem.utime += 39'000'000;
  send_problem();
  pass(2s);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_NE(verdicts.back().verdict, "good");
}

TEST_F(SavedMemories, OfAnotherRigOrDamagedAreRefusedAndCounted) {
  start();
  play(drive(100), 100);
  pass(3s);
  kill();
  const bus::Rig same = rig;
  rig.sensors[1].scale = 2;
  start();
  pass(2s);
  EXPECT_EQ(count("rejected: saved state that does not fit"), 1);
  EXPECT_THAT(status.last_error, HasSubstr("another rig or version"));
  EXPECT_TRUE(std::filesystem::exists(file + ".refused"));
  host.reset();
  rig = same;
  std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
  bytes.seekp(400);
  bytes.put('x');
  bytes.close();
  start();
  pass(2s);
  EXPECT_EQ(count("rejected: saved state that does not fit"), 1);
  EXPECT_EQ(count("restored"), 0);
}

TEST_F(SavedMemories, AreWrittenEverySecondSecondAtMost) {
  start();
  const testing::Streams streams = drive(200);
  int written = 0;
  auto last = std::filesystem::file_time_type::min();
  for (std::size_t end = 5; end <= 200; end += 5) {
    play(streams, end);
    const auto time = std::filesystem::exists(file) ? std::filesystem::last_write_time(file)
                                                    : std::filesystem::file_time_type::min();
    written += time != last;
    last = time;
  }
  EXPECT_GE(written, 6);
  EXPECT_LE(written, 11) << "in 20 s";
  std::filesystem::remove(file);
  play(drive(230), 230);
  EXPECT_TRUE(std::filesystem::exists(file)) << "a file that is removed is written again";
}

TEST_F(SavedMemories, ADiskThatTakesNothingEndsNothing) {
  start();
  play(drive(100), 100);
  std::filesystem::remove_all(folder);
  std::ofstream(folder) << "in the way";
  play(drive(200), 200);
  EXPECT_THAT(status.last_error, HasSubstr(file));
  ASSERT_FALSE(verdicts.empty());
  std::filesystem::remove(folder);
  play(drive(300), 300);
  EXPECT_EQ(status.last_error, "");
  EXPECT_TRUE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace egocal::services
