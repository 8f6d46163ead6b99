// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes of `egocal up` that are killed, stopped or told, and what they keep.
#include <sched.h>
#include <sys/resource.h>

#include <functional>
#include <map>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/process.hpp"
#include "up.hpp"

namespace egocal::test_up_processes {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using test::children;
using test::lines;
using test::read;
using test::runs;
using test::send_signal;
using test::until;
using test::Up;
using ::testing::HasSubstr;
using ::testing::Not;

// It was in the output of pairing alone: the user who asked for the state learnt of it on another day.
TEST_F(Up, AStateThatCannotBeSavedIsReported) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{4096, before.rlim_max};  // as a disk that is full; less than a state
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  ChildProcess egocal = up({"--log", log, "--speed", "10", "--state", path("kept")});
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")),
              HasSubstr("egocal up: egocal-pairing: " + path("kept") + ": cannot be written"));
}

TEST_F(Up, AnErrorThatIsOverIsReportedAsOver) {
  const std::string disk = path("disk"), away = path("away");
  std::filesystem::create_directories(disk);
  ChildProcess egocal = up({"--log", log, "--speed", "1", "--state", disk + "/kept"});
  const auto said = [&](const std::string& text) {
    return until([&] { return read(path("said")).find(text) != std::string::npos; });
  };
  ASSERT_TRUE(until([&] { return std::filesystem::exists(disk + "/kept"); }));
  take_away(disk, away);
  const std::string error = disk + "/kept";
  EXPECT_TRUE(said("egocal up: egocal-pairing: " + error)) << read(path("said"));
  std::filesystem::remove(disk);
  std::filesystem::create_directories(disk);
  EXPECT_TRUE(said("egocal up: egocal-pairing: this is over: " + error)) << read(path("said"));
  egocal.signal(SIGINT);
  EXPECT_EQ(egocal.wait(30s), 3) << "in the middle of the log";
}

// As by the kernel where memory is short. What it had heard is sent again each second.
TEST_F(Up, StartsItsOwnListenerAgain) {
  ChildProcess egocal = up({"--log", log, "--speed", "10"});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  std::this_thread::sleep_for(1100ms);
  send_signal(child(egocal.pid(), "egocal"), SIGKILL);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")),
              HasSubstr("egocal up: the process that listens to the bus has ended; it is started"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
}

// As an unmounted disk is: nothing can be kept there any more, but the drive goes on.
TEST_F(Up, APairingThatDiesWhenTheOutputFolderIsGoneCalibratesOn) {
  ChildProcess egocal = up({"--log", log, "--speed", "5"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  take_away(path("out"), path("away"));
  const pid_t killed = child(egocal.pid(), "egocal-pairing");
  send_signal(killed, SIGKILL);
  EXPECT_TRUE(until([&] {
    const pid_t now = child(egocal.pid(), "egocal-pairing");
    return now > 0 && now != killed;
  }));
  egocal.wait(60s);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing starts without the state file there"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: "));
  EXPECT_THAT(read(path("said")), Not(HasSubstr("egocal-pairing ended with exit code")));
}

// When a driver process dies, the last answer is still shown. Only the report says that it is old.
TEST_F(Up, APairWithoutNewMotionsIsReportedAndThatTheyComeAgain) {
  const std::string url = "udpm://239.255.76.67:7755?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  ChildProcess egocal = up({"--lcm-url", url});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  bus::LogReader drive(log);
  const std::int64_t begin_us = drive.next()->time_us, started_us = loop.mono_us();
  bool camera = true;
  // the log as a drive that is twice as fast
  const auto drives_until = [&](const std::function<bool(double)>& condition) {
    while (const auto event = drive.next()) {
      const std::int64_t due_us = started_us + (event->time_us - begin_us) / 2;
      while (loop.mono_us() < due_us) loop.run_once(std::chrono::microseconds(due_us - loop.mono_us()));
      if (camera || event->channel != "ODOMETRY_CAMERA") loop.publish_bytes(event->channel, event->data);
      if (condition(1e-6 * static_cast<double>(event->time_us - begin_us))) return true;
    }
    return false;
  };
  const auto said = [&](const std::string& text) {
    return drives_until([&](double) { return read(path("said")).find(text) != std::string::npos; });
  };
  ASSERT_TRUE(drives_until([](double seconds) { return seconds > 12; }));
  EXPECT_THAT(read(path("said")), Not(HasSubstr("motion")));
  camera = false;
  EXPECT_TRUE(said("egocal up: lidar -> camera: no new motion for 5 s: camera sends nothing\n"))
      << read(path("said"));
  camera = true;
  EXPECT_TRUE(said("egocal up: lidar -> camera: new motions come again\n")) << read(path("said"));
  egocal.signal(SIGINT);
  EXPECT_EQ(egocal.wait(30s), 0);
}

TEST_F(Up, AProcessThatWasStoppedIsContinuedAndNothingIsLost) {
  ChildProcess egocal = up({"--log", log, "--speed", "5"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  std::this_thread::sleep_for(1s);  // its status was heard
  send_signal(child(egocal.pid(), "egocal-pairing"), SIGSTOP);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing is silent for "));
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven), 400 motion pairs"));
}

/// Takes nearly all of the core of another process while it exists.
class Load {
 public:
  explicit Load(pid_t victim) : victim_(victim) {
    cpu_set_t all, one;
    sched_getaffinity(0, sizeof all, &all);
    CPU_ZERO(&one);
    for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
      if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
    sched_setaffinity(busy_.pid(), sizeof one, &one);
    sched_setaffinity(victim, sizeof one, &one);
    setpriority(PRIO_PROCESS, static_cast<id_t>(victim), 19);
  }
  ~Load() {
    setpriority(PRIO_PROCESS, static_cast<id_t>(victim_), 0);
    busy_.signal(SIGKILL);
    busy_.wait(10s);
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  pid_t victim_;
  ChildProcess busy_{{"/bin/sh", "-c", "while :; do :; done"}};
};

// It was reported as one that hangs: a diagnosis sends no status, and took more than 5 s on a busy machine.
TEST_F(Up, ADiagnosisThatComputesForLongIsLeftAloneUnlessItIsStopped) {
  const std::string url = "udpm://239.255.76.67:7754?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  std::int64_t heard_us = loop.mono_us();
  bool announced = false;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.role != "diagnosis") return;
    heard_us = loop.mono_us();
    announced = bus::announced_silence(status) > 0s;
  });
  const auto computes_for = [&](std::chrono::microseconds time) {
    return until(
        [&] {
          loop.run_once(10ms);
          return announced && loop.mono_us() - heard_us > time.count();
        },
        90s);
  };
  ChildProcess egocal = up({"--lcm-url", url, "--log", log, "--speed", "2"});
  ASSERT_TRUE(computes_for(0s)) << "never";
  const pid_t diagnosis = child(egocal.pid(), "egocal-diagnosi");
  {
    const Load load(diagnosis);
    if (!computes_for(6500ms)) GTEST_SKIP() << "its priority changes nothing here";
    EXPECT_THAT(read(path("said")), Not(HasSubstr("egocal-diagnosis is silent")));
    send_signal(diagnosis, SIGSTOP);
    EXPECT_TRUE(until(
        [&] { return read(path("said")).find("egocal-diagnosis is silent for") != std::string::npos; }));
  }
  EXPECT_TRUE(until([&] {
    loop.run_once(10ms);
    return read(path("said")).find("egocal-diagnosis is heard again") != std::string::npos;
  })) << "it is continued";
  EXPECT_EQ(child(egocal.pid(), "egocal-diagnosi"), diagnosis);
  egocal.signal(SIGINT);
  egocal.wait(30s);
}

TEST_F(Up, RestartsWhatIsKilledAndEndsWithCtrlC) {
  ChildProcess egocal = up({});
  const pid_t self = egocal.pid();
  for (const std::string name : {"egocal-fast", "egocal-pairing", "egocal-global"}) {
    ASSERT_TRUE(until([&] { return child(self, name) > 0; })) << name;
    const pid_t before = child(self, name);
    send_signal(before, SIGKILL);
    ASSERT_TRUE(until([&] {
      const pid_t now = child(self, name);
      return now > 0 && now != before;
    })) << name;
    EXPECT_THAT(read(path("said")), HasSubstr(name + " ended (killed by signal 9"));
  }
  ASSERT_TRUE(until([&] { return all_run(self, calibrating); }));
  const auto all = children(self);
  egocal.signal(SIGINT);
  EXPECT_EQ(egocal.wait(30s), 0);
  for (const auto& [id, name] : all) EXPECT_FALSE(runs(id)) << name;
  EXPECT_THAT(read(path("said")), Not(HasSubstr("did not end")));
}

TEST_F(Up, AKilledPairingCostsNothing) {
  const auto last_problem = [&](bool killed) {
    const std::string url = "udpm://239.255.76.67:" + std::to_string(killed ? 7751 : 7752) + "?ttl=0";
    bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
    problem_t problem{};
    loop.subscribe<problem_t>(bus::problem_channel("lidar", "camera"),
                              [&](const problem_t& message, const bus::Arrival&) { problem = message; });
    ChildProcess egocal = up({"--log", log, "--speed", "20", "--lcm-url", url});
    bool done = false;
    EXPECT_TRUE(until(
        [&] {
          loop.run_once(5ms);
          if (killed && problem.seq > 150) {
            // edited meanwhile: the one that takes its place knows the rig that was checked
            std::string other = read(rig);
            other.replace(other.find("camera"), 6, "kamera");
            std::ofstream(rig) << other;
            send_signal(child(egocal.pid(), "egocal-pairing"), SIGKILL);
            killed = false;
          }
          return done = done || egocal.wait(0ms) == 0;
        },
        60s))
        << read(path("said"));
    for (int i = 0; i < 10; ++i) loop.run_once(5ms);  // what waits in the socket
    return problem;
  };
  const problem_t expected = last_problem(false), found = last_problem(true);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing ended (killed by signal 9"));
  EXPECT_EQ(expected.seq, 399);
  EXPECT_EQ(found.seq, expected.seq);
  EXPECT_EQ(found.session, expected.session);
  EXPECT_EQ(found.matched, expected.matched);
  ASSERT_EQ(found.blocks.size(), expected.blocks.size());
  for (std::size_t i = 0; i < found.blocks.size(); ++i)
    EXPECT_EQ(bus::encode(found.blocks[i]), bus::encode(expected.blocks[i]));
  for (const auto& entry : std::filesystem::directory_iterator(path("out")))
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("state")));
}

TEST_F(Up, TheirProcessesCanBeTold) {
  const std::string url = "udpm://239.255.76.67:7753?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  std::string state;
  std::int64_t out = 0;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.name != "egocal-player") return;
    state = status.state;
    for (const counter_t& counter : status.counters)
      if (counter.name == "out") out = counter.value;
  });
  const auto tell = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {paths::bin_dir() + "/egocal", "tell", "--lcm-url", url});
    std::filesystem::remove(path("told"));
    return ChildProcess(words, path("told")).wait(30s);
  };
  EXPECT_EQ(tell({"egocal-player", "pause"}), 1);
  EXPECT_EQ(lines(path("told")).size(), 1u);
  EXPECT_EQ(tell({"egocal-player", "dance"}), 2);
  EXPECT_EQ(tell({"egocal-player", "seek"}), 2);
  EXPECT_EQ(tell({"egocal-player", "seek", "x"}), 2);
  EXPECT_EQ(tell({"egocal-player", "pause", "1"}), 2);
  ChildProcess egocal = up({"--log", log, "--lcm-url", url});
  const auto seen = [&](const std::function<bool()>& condition) {
    return until([&] {
      loop.run_once(5ms);
      return condition();
    });
  };
  ASSERT_TRUE(seen([&] { return state == "running"; }));
  EXPECT_EQ(tell({"egocal-player", "pause"}), 0);
  ASSERT_TRUE(seen([&] { return state == "paused"; }));
  // verbs that the process would ignore
  for (const std::vector<std::string>& ignored : std::vector<std::vector<std::string>>{
           {"egocal-fast", "seek", "3"}, {"egocal-player", "reset"}, {"egocal-diagnosis", "reset"}}) {
    EXPECT_EQ(tell(ignored), 1) << ignored[0];
    ASSERT_EQ(lines(path("told")).size(), 1u) << read(path("told"));
    EXPECT_THAT(read(path("told")), HasSubstr("does not know " + ignored[1])) << ignored[0];
    EXPECT_THAT(read(path("told")), HasSubstr(ignored[1] == "seek" ? "egocal-player" : "egocal-pairing"));
  }
  EXPECT_EQ(tell({"egocal-diagnosis", "resume"}), 0);
  // for longer than others are silent, as one that computes: here until it is continued after five seconds
  send_signal(child(egocal.pid(), "egocal-diagnosi"), SIGSTOP);
  EXPECT_EQ(tell({"egocal-diagnosis", "resume"}), 0) << read(path("told"));
  EXPECT_THAT(read(path("told")), HasSubstr("egocal-diagnosis is not heard: waiting"));
  EXPECT_EQ(tell({"egocal-player", "seek", "3.5"}), 0);
  const std::int64_t before = out;
  EXPECT_EQ(tell({"egocal-player", "step"}), 0);
  EXPECT_TRUE(seen([&] { return out > before; }));
  EXPECT_EQ(tell({"egocal-player", "speed", "0"}), 0);
  EXPECT_EQ(tell({"egocal-player", "resume"}), 0);
  EXPECT_EQ(egocal.wait(60s), 0);
}

TEST_F(Up, LeavesNoOrphans) {
  ChildProcess egocal = up({"--log", log});
  const pid_t self = egocal.pid();
  ASSERT_TRUE(until([&] { return all_run(self, calibrating) && child(self, "egocal-player") > 0; }));
  const auto all = children(self);
  egocal.signal(SIGKILL);
  for (const auto& [id, name] : all) EXPECT_TRUE(until([id = id] { return !runs(id); })) << name;
}

TEST_F(Up, WhatWasAccumulatedIsKeptWhenItDidNotEndAsItShould) {
  ChildProcess egocal = up({"--log", log, "--speed", "5"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  egocal.signal(SIGKILL);
  egocal.wait(10s);
  ChildProcess next = up({"--log", log, "--speed", "0"});
  EXPECT_EQ(next.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("are kept in " + path("out/pairing-1.state")));
  EXPECT_TRUE(std::filesystem::exists(path("out/pairing-1.state")));
  EXPECT_FALSE(std::filesystem::exists(path("out/pairing-2.state")));
}

}  // namespace
}  // namespace egocal::test_up_processes
