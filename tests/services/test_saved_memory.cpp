// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal-diagnosis that is killed and continues from its state, in virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

#include "diagnosis/diagnosing.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "state/state_identity.hpp"
#include "support/file_content.hpp"
#include "support/mistakes.hpp"
#include "support/scratch_folder.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_saved_memory {
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
  Host(test::VirtualNetwork& network, const bus::Clock& clock, const bus::Rig& rig,
       std::unique_ptr<SavedMemory> saved, const DiagnosingOptions& options)
      : loop(network.transport(), clock, {.handle_signals = false}),
        heartbeat(loop, bus::Identity{"egocal-diagnosis", bus::Role::diagnosis, "1", 1}, 3s),
        service(loop, heartbeat, rig, std::move(saved), options) {}
  bus::Loop loop;
  bus::Heartbeat heartbeat;
  Diagnosing service;
};

class SavedMemories : public ::testing::Test {
 protected:
  SavedMemories() {
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

  void start() {
    auto saved = std::make_unique<SavedMemory>(file, rig, state_clock);
    host = std::make_unique<Host>(network, clock, rig, std::move(saved), options);
  }
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

  const testing::ScratchFolder scratch;
  const std::string folder = scratch.path().string(), file = scratch.path("diagnosis.state");
  test::VirtualClock clock;
  test::VirtualNetwork network{clock};
  bus::Loop observer{network.transport(), clock, {.handle_signals = false}};
  bus::Rig rig;
  DiagnosingOptions options;
  StateFile::Clock state_clock = boot_time;
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

/// A slip on the command line must not cost pairing its statistics, nor a person a file.
TEST_F(SavedMemories, WhatIsNotTheDiagnosisIsNotTouched) {
  const auto content = [this] {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto write = [this](const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; };
  const auto expect_untouched = [&] {
    const std::string before = content();
    std::string why;
    try {
      start();
    } catch (const Error& error) {
      why = error.what();
    }
    EXPECT_EQ(why, file + ": is not a state of egocal-diagnosis; expected one, or no file");
    EXPECT_EQ(content(), before);
    EXPECT_FALSE(std::filesystem::exists(file + ".refused"));
  };
  write("hello\n");
  expect_untouched();
  StateFile(open_state_medium(file), state_identity("egocal-pairing", 1, rig)).snapshot({});
  expect_untouched();
  std::string of_version_3 = content();
  of_version_3.at(of_version_3.find('4')) = '3';
  write(of_version_3);
  expect_untouched();
  write(of_version_3.substr(0, 30));
  expect_untouched();
}

/// Up to version 3 they began as pairing's did.
TEST_F(SavedMemories, OfEarlierBuildsAreKeptAside) {
  StateFile(open_state_medium(file), {"egocal-pairing", state_identity("egocal-diagnosis", 1024, rig).text})
      .snapshot({});
  std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
  bytes.seekp(static_cast<std::streamoff>(std::string("egocal-pairing state ").size()));
  bytes.put('3');
  bytes.close();
  start();
  pass(2s);
  EXPECT_EQ(count("rejected: saved state that does not fit"), 1);
  EXPECT_THAT(status.last_error, HasSubstr("another version or machine"));
  EXPECT_TRUE(std::filesystem::exists(file + ".refused"));
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

// It was an error for ever, or until the disk took a state again
TEST_F(SavedMemories, AFailedDiagnosisIsAnErrorUntilTheNextOneSucceeds) {
  bool fails = true;
  options.diagnose = [&fails](const auto& a, const auto& b, const auto& drive, const auto& answered,
                              const auto& goal) {
    if (fails) throw Error("no memory left");
    return diagnose(a, b, drive, answered, goal);
  };
  start();
  const testing::Streams streams = drive(500);
  play(streams, 100);
  EXPECT_EQ(status.last_error, "left -> right: no memory left");
  std::filesystem::remove_all(folder);
  std::ofstream(folder) << "in the way";
  play(streams, 200);
  EXPECT_EQ(status.last_error, "left -> right: no memory left");
  std::filesystem::remove(folder);
  play(streams, 300);
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ(status.last_error, "left -> right: no memory left") << "only the disk's error is over";
  fails = false;
  play(streams, 400);
  pass(3s);
  EXPECT_EQ(status.last_error, "");
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
}

TEST_F(SavedMemories, WhateverFailsAtTheEndEndsNothingElse) {
  bool fails = false;
  state_clock = [&fails] {
    if (fails) throw std::runtime_error("no clock");
    return boot_time();
  };
  start();
  play(drive(100), 100);
  const std::string before = testing::content_of(file);
  EXPECT_FALSE(before.empty());
  fails = true;
  host.reset();
  EXPECT_EQ(testing::content_of(file), before) << "a state that cannot be written whole is that of before";
}

}  // namespace
}  // namespace egocal::services::test_saved_memory
