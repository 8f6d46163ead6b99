// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal up` with the real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"
#include "supervised.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using test::children;
using test::lines;
using test::read;
using test::runs;
using test::Supervision;
using test::until;
using ::testing::HasSubstr;
using ::testing::Not;

/// The real thing.
class Up : public Supervision {
 protected:
  Up() : rig(path("drive.toml")), log(path("drive.log")) {
    const int code = ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig,
                                   "--poses", "400", "--noise", "0.001"})
                         .wait(60s);
    EXPECT_EQ(code, 0);
  }
  ChildProcess up(std::vector<std::string> more) const {
    static int port = 7780;
    std::vector<std::string> arguments{paths::bin_dir() + "/egocal",
                                       "up",
                                       rig,
                                       "--output-dir",
                                       path("out"),
                                       "--lcm-url",
                                       "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0"};
    if (std::find(more.begin(), more.end(), "--lcm-url") != more.end())
      arguments.resize(arguments.size() - 2);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ChildProcess(arguments, path("said"));
  }
  static pid_t child(pid_t parent, const std::string& name) {
    for (const auto& [pid, its_name] : children(parent))
      if (its_name == name) return pid;
    return -1;
  }
  /// All of these run; /proc knows the first 15 characters of a name.
  static bool all_run(pid_t parent, const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(),
                       [&](const std::string& name) { return child(parent, name.substr(0, 15)) > 0; });
  }
  const std::vector<std::string> calibrating{"egocal-pairing", "egocal-fast", "egocal-global",
                                             "egocal-diagnosis"};

  std::string rig, log;
};

TEST_F(Up, PlaysALogToItsEndAndEndsAll) {
  ChildProcess egocal = up({"--log", log, "--speed", "0", "--follow", "--report"});
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  const std::string page = read(path("out/report-lidar-camera.html"));
  EXPECT_THAT(page, HasSubstr("good: "));
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_THAT(read(path("said")), HasSubstr("report-lidar-camera.html: good: "));
  for (const char* name :
       {"egocal-pairing", "egocal-fast", "egocal-global", "egocal-diagnosis", "egocal-player"})
    EXPECT_TRUE(std::filesystem::exists(path("out/" + std::string(name) + ".out"))) << name;
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven)"));
}

TEST_F(Up, AnAnswerThatShouldNotBeUsedEndsWithThree) {
  ASSERT_EQ(ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig, "--poses",
                          "400", "--noise", "0.001", "--terrain", "free", "--scale", "camera=2.7"})
                .wait(60s),
            0);
  ChildProcess egocal = up({"--log", log, "--speed", "20"});
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: contradictory: "));
  EXPECT_THAT(read(path("said")), HasSubstr("Cure: "));
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven), "));
}

// The diagnosis takes a small share of a core: at the end of a log most of these pairs have not been judged,
// or by the part of the drive before the mount moved.
TEST_F(Up, WaitsUntilEveryPairOfALargeRigIsJudged) {
  std::vector<std::string> simulate{paths::bin_dir() + "/egocal",
                                    "simulate",
                                    "--out",
                                    log,
                                    "--rig-out",
                                    rig,
                                    "--poses",
                                    "800",
                                    "--noise",
                                    "0.005",
                                    "--terrain",
                                    "free",
                                    "--bump",
                                    "s6=50:0,0.05,0,0,4,0"};
  for (int i = 1; i <= 6; ++i) {
    simulate.push_back("--sensor");
    simulate.push_back("s" + std::to_string(i) + "=" + std::to_string(0.3 * i) + ",0,1,1,0,0,0");
  }
  ASSERT_EQ(ChildProcess(simulate).wait(60s), 0);
  std::string text = read(rig);
  text.resize(text.find("[[pair]]"));
  for (int a = 1; a <= 6; ++a)
    for (int b = a + 1; b <= 6; ++b)
      text += "[[pair]]\na = \"s" + std::to_string(a) + "\"\nb = \"s" + std::to_string(b) + "\"\n";
  std::ofstream(rig) << text;
  ChildProcess egocal = up({"--log", log, "--speed", "0"});
  EXPECT_EQ(egocal.wait(200s), 3) << read(path("said"));
  const std::string said = read(path("said"));
  for (int a = 1; a <= 6; ++a)
    for (int b = a + 1; b <= 6; ++b)
      EXPECT_THAT(said, HasSubstr("s" + std::to_string(a) + " -> s" + std::to_string(b) +
                                  (b == 6 ? ": contradictory: " : ": good: ")));
}

TEST_F(Up, NamesAPairWithoutAnAnswer) {
  std::ofstream(rig, std::ios::app) << "[[sensor]]\nname = \"radar\"\nchannel = \"RADAR\"\n"
                                       "[[pair]]\na = \"lidar\"\nb = \"radar\"\n";
  ChildProcess egocal = up({"--log", log, "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> radar: no answer"));
}

// The diagnosis keeps 1200 poses of a stream, the page shows all: here it was killed after it had seen the
// bump.
TEST_F(Up, APageThatContradictsEndsWithThreeWhateverTheProcessesSaid) {
  ASSERT_EQ(ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig, "--poses",
                          "600", "--noise", "0.001", "--terrain", "free", "--bump", "camera=20:0,0,0,0,6,0"})
                .wait(60s),
            0);
  ChildProcess egocal = up({"--log", log, "--speed", "10", "--report"});
  ASSERT_TRUE(until([&] { return child(egocal.pid(), "egocal-diagnosi") > 0; }));
  std::this_thread::sleep_for(4s);
  kill(child(egocal.pid(), "egocal-diagnosi"), SIGKILL);  // its successor knows nothing of the bump
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("report-lidar-camera.html: contradictory: The mounting changed"));
}

// Here by solvers that are gone; one that hangs leaves the same.
TEST_F(Up, AnAnswerWithoutTheEndOfTheLogIsNotOneOfTheLog) {
  std::filesystem::create_directory(path("bin"));
  std::filesystem::copy_file(paths::bin_dir() + "/egocal", path("bin/egocal"));
  for (const char* name :
       {"egocal-pairing", "egocal-fast", "egocal-global", "egocal-diagnosis", "egocal-player"})
    std::filesystem::create_symlink(paths::bin_dir() + "/" + name, path("bin/" + std::string(name)));
  ChildProcess egocal({path("bin/egocal"), "up", rig, "--log", log, "--speed", "4", "--output-dir",
                       path("out"), "--lcm-url", "udpm://239.255.76.67:7756?ttl=0"},
                      path("said"));
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  std::this_thread::sleep_for(3s);
  for (const char* name : {"egocal-fast", "egocal-global"}) {
    std::filesystem::remove(path("bin/" + std::string(name)));
    kill(child(egocal.pid(), name), SIGKILL);
  }
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  const std::string said = read(path("said"));
  EXPECT_THAT(said, HasSubstr("lidar -> camera: no solver answers the motions of the last 5 s"));
  EXPECT_THAT(said, HasSubstr("lidar -> camera: old answer, the last "));
  EXPECT_THAT(said, HasSubstr("are not in it (no solver answered them). Before: good: "));
}

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
  ChildProcess egocal = up({"--log", log, "--speed", "2", "--state", disk + "/kept"});
  const auto said = [&](const std::string& text) {
    return until([&] { return read(path("said")).find(text) != std::string::npos; });
  };
  ASSERT_TRUE(until([&] { return std::filesystem::exists(disk + "/kept"); }));
  std::filesystem::rename(disk, away);
  std::ofstream(disk) << "no folder";
  const std::string error = disk + "/kept";
  EXPECT_TRUE(said("egocal up: egocal-pairing: " + error)) << read(path("said"));
  std::filesystem::remove(disk);
  std::filesystem::create_directories(disk);
  EXPECT_TRUE(said("egocal up: egocal-pairing: this is over: " + error)) << read(path("said"));
  egocal.signal(SIGINT);
  EXPECT_EQ(egocal.wait(30s), 3) << "in the middle of the log";
}

// As a recorder that rotates its logs does. It was "nothing was calibrated: no solver answered".
TEST_F(Up, ALogThatIsRemovedWhileItIsPlayedIsStillPlayedAndJudged) {
  ChildProcess egocal = up({"--log", log, "--speed", "10"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  std::this_thread::sleep_for(1s);
  std::filesystem::remove(log);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
  EXPECT_THAT(read(path("said")), HasSubstr(", 400 motion pairs; "));
}

// As by the kernel where memory is short. What it had heard is sent again each second.
TEST_F(Up, StartsItsOwnListenerAgain) {
  ChildProcess egocal = up({"--log", log, "--speed", "10"});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  std::this_thread::sleep_for(1100ms);
  kill(child(egocal.pid(), "egocal"), SIGKILL);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")),
              HasSubstr("egocal up: the process that listens to the bus has ended; it is started"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
}

// As an unmounted disk is: nothing can be kept there any more, but the drive goes on.
TEST_F(Up, APairingThatDiesWhenTheOutputFolderIsGoneCalibratesOn) {
  ChildProcess egocal = up({"--log", log, "--speed", "5"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  std::filesystem::remove_all(path("out"));
  std::ofstream(path("out")) << "in its place\n";
  const pid_t killed = child(egocal.pid(), "egocal-pairing");
  kill(killed, SIGKILL);
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
  ChildProcess egocal = up({"--log", log, "--speed", "10"});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  std::this_thread::sleep_for(2s);
  kill(child(egocal.pid(), "egocal-pairing"), SIGSTOP);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing is silent for "));
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven), 400 motion pairs"));
}

TEST_F(Up, RestartsWhatIsKilledAndEndsWithCtrlC) {
  ChildProcess egocal = up({});
  const pid_t self = egocal.pid();
  for (const std::string name : {"egocal-fast", "egocal-pairing", "egocal-global"}) {
    ASSERT_TRUE(until([&] { return child(self, name) > 0; })) << name;
    const pid_t before = child(self, name);
    kill(before, SIGKILL);
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
    ChildProcess egocal = up({"--log", log, "--speed", "40", "--lcm-url", url});
    bool done = false;
    EXPECT_TRUE(until(
        [&] {
          loop.run_once(5ms);
          if (killed && problem.seq > 150) {
            // edited meanwhile: the one that takes its place knows the rig that was checked
            std::string other = read(rig);
            other.replace(other.find("camera"), 6, "kamera");
            std::ofstream(rig) << other;
            kill(child(egocal.pid(), "egocal-pairing"), SIGKILL);
            killed = false;
          }
          return done = done || egocal.wait(0ms) == 0;
        },
        60s))
        << read(path("said"));
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

TEST_F(Up, SaysInOneLineWhatIsWrong) {
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {paths::bin_dir() + "/egocal", "up"});
    std::filesystem::remove(path("said"));
    EXPECT_EQ(ChildProcess(arguments, path("said")).wait(30s), 1);
    EXPECT_EQ(lines(path("said")).size(), 1u) << read(path("said"));
  };
  refused({rig, "--lcm-url", "udpm://nowhere:1"});
  refused({rig, "--log", path("none.log")});
  refused({path("none.toml")});
  refused({rig, "--output-dir", rig + "/in"});
  refused({rig, "--state", "/nonexistent/x"});
  refused({rig, "--state", path("")});
}

// Each of them was tried again and again, without an end.
TEST_F(Up, RefusesAStateThatCanNeverBeOne) {
  std::filesystem::copy_file(rig, path("text"));
  std::filesystem::create_symlink("loop", path("loop"));
  std::filesystem::create_directory(path("a.lock"));
  std::filesystem::copy_file(rig, path("b.diagnosis"));
  std::ofstream(path("c")) << "egocal-diagnosis state 4l\n";
  const std::map<std::string, std::string> why{{"text", "text: is not a state of egocal-pairing"},
                                               {"loop", "loop: cannot be read"},
                                               {"a", "a.lock: is there and is not a file"},
                                               {"b", "b.diagnosis: is not a state of egocal-diagnosis"},
                                               {"c", "c: is not a state of egocal-pairing"}};
  std::filesystem::create_directory(path("said"));
  std::map<std::string, ChildProcess> started;  // each listens for a second first
  for (const auto& [state, what] : why)
    started.emplace(
        state, ChildProcess({paths::bin_dir() + "/egocal", "up", rig, "--state", path(state), "--output-dir",
                             path("out"), "--lcm-url", "udpm://239.255.76.67:7759?ttl=0"},
                            path("said/" + state)));
  for (auto& [state, egocal] : started) {
    EXPECT_EQ(egocal.wait(30s), 1) << state;
    const std::string said = read(path("said/" + state));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_THAT(said, ::testing::StartsWith("egocal up: "));
    EXPECT_THAT(said, HasSubstr(why.at(state)));
  }
  std::vector<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(path("")))
    there.push_back(entry.path().filename());
  EXPECT_THAT(there, ::testing::UnorderedElementsAre("drive.toml", "drive.log", "said", "text", "loop",
                                                     "a.lock", "b.diagnosis", "c"));
}

// The processes read it again and found it empty, without an end. A report that could not be written ended
// all.
TEST_F(Up, TakesARigThatCanBeReadOnceAndNeedsNoStandardError) {
  const std::string command = "cat '" + rig + "' | " + paths::bin_dir() + "/egocal up /dev/stdin --log '" +
                              log + "' --speed 0 --lcm-url 'udpm://239.255.76.67:7757?ttl=0' --output-dir '" +
                              path("out") + "' 2>&-";
  ChildProcess egocal({"sh", "-c", command}, path("said"));
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
  ChildProcess full({"sh", "-c", paths::bin_dir() + "/egocal up '" + path("none.toml") + "' 2>/dev/full"});
  EXPECT_EQ(full.wait(10s), 1);
}

// It was "nothing was calibrated: pairing found no motion".
TEST_F(Up, SaysThatNobodyTakesTheMonitorsLines) {
  ChildProcess egocal({"sh", "-c",
                       paths::bin_dir() + "/egocal up '" + rig + "' --log '" + log +
                           "' --follow --lcm-url 'udpm://239.255.76.67:7758?ttl=0' --output-dir '" +
                           path("out") + "' 2>'" + path("said") + "' >/dev/full"});
  EXPECT_EQ(egocal.wait(30s), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal up: standard output is gone"));
  EXPECT_THAT(read(path("said")), Not(HasSubstr("no motion")));
}

// It was killed by the signal, in the time in which it looks for another pairing.
TEST_F(Up, EndsWithCtrlCBeforeAnythingIsStarted) {
  const auto ended = [&](const std::vector<std::string>& more) {
    ChildProcess egocal = up(more);
    EXPECT_TRUE(until([&] {
      std::uint64_t caught = 0;
      for (const std::string& line : lines("/proc/" + std::to_string(egocal.pid()) + "/status"))
        if (line.starts_with("SigCgt:")) caught = std::stoull(line.substr(7), nullptr, 16);
      return (caught >> (SIGINT - 1) & 1) != 0;
    }));
    egocal.signal(SIGINT);
    return egocal.wait(10s);
  };
  EXPECT_EQ(ended({}), 0);
  EXPECT_EQ(ended({"--log", log}), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal up: ended before the log was played"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Up, ChecksTheLogBeforeItPlaysIt) {
  {
    bus::LogWriter writer(path("other.log"));
    StampedPose pose;
    pose.time_us = 1'700'000'000'000'000;
    writer.write(pose.time_us, "SOMETHING_ELSE", bus::encode(bus::to_message(pose, 0)));
    writer.close();
  }
  ChildProcess other = up({"--log", path("other.log")});
  EXPECT_EQ(other.wait(30s), 1);
  EXPECT_EQ(lines(path("said")).size(), 1u) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("is not in the log; there are: SOMETHING_ELSE"));
}

// It was "no solver answered".
TEST_F(Up, SaysWhyNothingWasCalibrated) {
  {
    bus::LogReader all(log);
    bus::LogWriter writer(path("held.log"));
    odometry_t held{};
    for (int i = 0; const auto event = all.next();) {
      odometry_t pose{};
      ASSERT_GE(pose.decode(event->data.data(), 0, static_cast<int>(event->data.size())), 0);
      if (event->channel == "ODOMETRY_CAMERA") {
        if (i++ % 10 == 0) held = pose;
        std::copy(std::begin(held.pos), std::end(held.pos), pose.pos);
        std::copy(std::begin(held.quat), std::end(held.quat), pose.quat);
      }
      writer.write(event->time_us, event->channel, bus::encode(pose));
    }
    writer.close();
  }
  ChildProcess egocal = up({"--log", path("held.log"), "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 1) << read(path("said"));
  EXPECT_THAT(read(path("said")),
              HasSubstr("nothing was calibrated: pairing found no motion: it rejected 36"));
  EXPECT_THAT(read(path("said")), HasSubstr(" x frozen (one odometry repeats the same pose"));
}

TEST_F(Up, FailsWhereNothingWasCalibrated) {
  {
    bus::LogReader all(log);
    bus::LogWriter writer(path("short.log"));
    for (int i = 0; i < 2; ++i)
      if (const auto event = all.next()) writer.write(event->time_us, event->channel, event->data);
    writer.close();
  }
  ChildProcess egocal = up({"--log", path("short.log"), "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 1) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("nothing was calibrated"));
}

TEST_F(Up, ASecondOneOnTheSameBusRefusesUnlessItIsToJoin) {
  const std::string url = "udpm://239.255.76.67:7754?ttl=0";
  ChildProcess first = up({"--lcm-url", url});
  ASSERT_TRUE(until([&] { return child(first.pid(), "egocal-pairing") > 0; }));
  std::this_thread::sleep_for(500ms);
  std::filesystem::remove(path("said"));
  ChildProcess second = up({"--lcm-url", url});
  EXPECT_EQ(second.wait(30s), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("egocal-pairing (pid "));
  ChildProcess joined = up({"--lcm-url", url, "--join"});
  EXPECT_TRUE(until([&] { return child(joined.pid(), "egocal-pairing") > 0; }));
  for (ChildProcess* egocal : {&joined, &first}) {
    egocal->signal(SIGINT);
    EXPECT_EQ(egocal->wait(30s), 0);
  }
}

TEST_F(Up, WhatWasAccumulatedIsKeptWhenItDidNotEndAsItShould) {
  ChildProcess egocal = up({"--log", log, "--speed", "40"});
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
}  // namespace egocal

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && !egocal::test::enter_network_namespace()) return 1;
  return RUN_ALL_TESTS();
}
