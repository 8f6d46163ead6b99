// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that die, hang, or are ended: the supervisor with small scripts, and `egocal up` with the real
// ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using ::testing::HasSubstr;
using ::testing::Not;
using tools::Program;
using tools::SupervisorOptions;

bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout = 30s) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

std::string read(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines(const std::string& file) {
  std::istringstream stream(read(file));
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

bool runs(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(") ");
  return name_end != std::string::npos && text[name_end + 2] != 'Z' && text[name_end + 2] != 'X';
}

/// Process ids and names of the children of a process.
std::vector<std::pair<pid_t, std::string>> children(pid_t parent) {
  std::vector<std::pair<pid_t, std::string>> result;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); })) continue;
    std::string text;  // empty where the process has just ended
    std::getline(std::ifstream(entry.path() / "stat"), text);
    const std::size_t open = text.find('('), close = text.rfind(") ");
    if (open == std::string::npos || close == std::string::npos) continue;
    char state = 0;
    pid_t ppid = 0;
    std::istringstream(text.substr(close + 2)) >> state >> ppid;
    if (ppid == parent && state != 'Z')
      result.emplace_back(std::stoi(name), text.substr(open + 1, close - open - 1));
  }
  return result;
}

class Supervision : public ::testing::Test {
 protected:
  Supervision() {
    static int number = 0;
    folder = std::filesystem::temp_directory_path() /
             ("egocal-up-" + std::to_string(getpid()) + "-" + std::to_string(++number));
    std::filesystem::create_directories(folder);
    options.output_dir = folder;
    options.restarts.first_back_off = 50ms;
    options.restarts.longest_back_off = 400ms;
    options.settle = 100ms;
  }
  ~Supervision() override {
    if (pid > 0) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
    std::filesystem::remove_all(folder);
  }
  std::string path(const std::string& name) const { return folder / name; }

  /// A shell script; $F is the folder.
  Program script(const std::string& name, const std::string& text) const {
    Program program;
    program.name = name;
    program.command = {"/bin/sh", "-c", "F=" + folder.string() + "\n" + text};
    return program;
  }
  /// A script that waits for a signal, and writes each one down.
  Program waiting(const std::string& name, const std::string& ending = "exit 0") const {
    return script(name, "trap 'echo INT >>$F/" + name + ".signals; " + ending +
                            "' INT\ntrap 'echo TERM >>$F/" + name + ".signals; " + ending +
                            "' TERM\necho $$ >>$F/" + name + ".pids\nwhile :; do sleep 0.05; done");
  }
  void start(const std::vector<Program>& programs) {
    pid = fork();
    if (pid != 0) return;
    if (!std::freopen(path("said").c_str(), "a", stderr)) _exit(99);
    int code = 98;
    try {
      code = tools::supervise(programs, options);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      code = 97;
    }
    std::fflush(stderr);
    _exit(code);
  }
  int ended() {
    int state = 0;
    if (!until([&] { return waitpid(pid, &state, WNOHANG) == pid; })) return -1;
    pid = -1;
    return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  }
  /// The process that runs under this name, once that many have been started.
  pid_t process(const std::string& name, std::size_t starts = 1) const {
    EXPECT_TRUE(until([&] { return lines(path(name + ".pids")).size() >= starts; })) << name;
    const auto pids = lines(path(name + ".pids"));
    return pids.size() < starts ? -1 : std::stoi(pids[starts - 1]);
  }

  std::filesystem::path folder;
  SupervisorOptions options;
  pid_t pid = -1;
};

TEST_F(Supervision, WhatDiesAtOnceIsStartedAgainWithGrowingPausesForEver) {
  start({waiting("good"), script("bad", "date +%s%N >>$F/starts; echo 'no network' >&2; exit 1")});
  ASSERT_TRUE(until([&] { return lines(path("starts")).size() >= 40; }, 60s));
  const auto starts = lines(path("starts"));
  for (std::size_t i = 1; i < starts.size(); ++i)
    EXPECT_GT(1e-6 * static_cast<double>(std::stoll(starts[i]) - std::stoll(starts[i - 1])),
              std::min(50 * (1 << std::min<std::size_t>(i - 1, 10)), 400) - 1)
        << "pause " << i << " [ms]";
  EXPECT_TRUE(runs(process("good")));
  kill(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")),
              HasSubstr("bad ended (exit code 1: no network), starting it again in 100 ms"));
  EXPECT_LE(lines(path("said")).size(), 6u) << "the same death is not reported again and again";
  EXPECT_EQ(lines(path("good.signals")), std::vector<std::string>{"TERM"});
}

TEST_F(Supervision, WhatCannotWorkIsGivenUpAtOnce) {
  start({script("usage", "echo x >>$F/starts; exit 2")});
  EXPECT_EQ(ended(), 1);
  EXPECT_EQ(lines(path("starts")).size(), 1u);
  Program missing;
  missing.name = "missing";
  missing.command = {path("no-such-program")};
  start({missing});
  EXPECT_EQ(ended(), 1);
  EXPECT_THAT(read(path("said")), HasSubstr("missing cannot be started (exit code 127: cannot be started)"));
}

TEST_F(Supervision, WhatHasWorkedIsNotGivenUpWhateverItSays) {
  options.restarts.started_well = 100ms;
  // the program is replaced while it runs: for a moment it cannot be executed
  start({script("one", "echo x >>$F/starts; [ $(wc -l <$F/starts) -gt 1 ] && exit 127; sleep 0.3; exit 1")});
  EXPECT_TRUE(until([&] { return lines(path("starts")).size() >= 4; }));
  kill(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
}

TEST_F(Supervision, AnOutputFolderThatIsGoneEndsNothing) {
  options.output_dir = path("out");
  std::filesystem::create_directories(path("out"));
  start({waiting("one"), waiting("two")});
  process("two");
  std::filesystem::remove_all(path("out"));
  kill(process("one"), SIGKILL);
  process("one", 2);
  EXPECT_TRUE(std::filesystem::exists(path("out/one.out"))) << "it is made again";
  // a name that cannot be written: by root, too
  std::filesystem::remove(path("out/one.out"));
  std::filesystem::create_directories(path("out/one.out"));
  kill(process("one", 2), SIGKILL);
  EXPECT_TRUE(runs(process("one", 3)));
  EXPECT_TRUE(runs(process("two")));
  kill(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")), HasSubstr("one.out: cannot be written"));
}

TEST_F(Supervision, WhatIsKilledIsStartedAgainAndTheOthersGoOn) {
  start({waiting("one"), waiting("two")});
  const pid_t two = process("two");
  kill(process("one"), SIGKILL);
  const pid_t again = process("one", 2);
  EXPECT_TRUE(runs(again));
  EXPECT_TRUE(runs(two));
  EXPECT_EQ(lines(path("two.pids")).size(), 1u);
  kill(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_FALSE(runs(again));
  EXPECT_FALSE(runs(two));
}

TEST_F(Supervision, SignalsArePassedOnOnce) {
  for (const auto& [sent, passed] : {std::pair{SIGINT, "INT"}, {SIGTERM, "TERM"}, {SIGHUP, "TERM"}}) {
    for (const char* name : {"one", "two"})
      for (const char* suffix : {".signals", ".pids"})
        std::filesystem::remove(path(name + std::string(suffix)));
    // slow to end: a second signal would be seen
    start({waiting("one", "sleep 0.3; exit 0"), waiting("two")});
    process("one");
    process("two");
    kill(pid, sent);
    EXPECT_EQ(ended(), 0);
    for (const char* name : {"one", "two"})
      EXPECT_EQ(lines(path(name + std::string(".signals"))), std::vector<std::string>{passed}) << name;
  }
}

TEST_F(Supervision, CtrlCReachesEachProcessOnce) {
  int master = -1;
  Program foreground = waiting("foreground", "sleep 0.3; exit 0");
  foreground.foreground = true;
  const Program background = waiting("background", "sleep 0.3; exit 0");
  pid = forkpty(&master, nullptr, nullptr, nullptr);
  if (pid == 0) _exit(tools::supervise({background, foreground}, options));
  process("background");
  process("foreground");
  ASSERT_EQ(write(master, "\x03", 1), 1);
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(lines(path("background.signals")), std::vector<std::string>{"INT"});
  EXPECT_EQ(lines(path("foreground.signals")), std::vector<std::string>{"INT"});
  close(master);
}

TEST_F(Supervision, NothingIsLeftWhenTheSupervisorIsKilled) {
  start({waiting("one"), waiting("two")});
  const pid_t one = process("one"), two = process("two");
  kill(pid, SIGKILL);
  EXPECT_EQ(ended(), 128 + SIGKILL);
  EXPECT_TRUE(until([&] { return !runs(one) && !runs(two); }));
  EXPECT_EQ(lines(path("one.signals")), std::vector<std::string>{"TERM"});
}

TEST_F(Supervision, WhatDoesNotEndIsKilled) {
  options.patience = 300ms;
  start({script("deaf", "trap '' TERM INT; echo $$ >>$F/deaf.pids; while :; do sleep 0.05; done")});
  const pid_t deaf = process("deaf");
  kill(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_FALSE(runs(deaf));
  EXPECT_THAT(read(path("said")), HasSubstr("deaf did not end and is killed"));
}

TEST_F(Supervision, AllEndWithThePlayerOrTheMonitor) {
  Program player = script("player", "echo played; exit 0");
  player.ends_all = true;
  start({waiting("one"), player});
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(lines(path("one.signals")), std::vector<std::string>{"TERM"});

  std::filesystem::remove(path("one.signals"));
  Program monitor = script("monitor", "exit 0");
  monitor.foreground = true;
  start({waiting("one"), monitor});
  EXPECT_EQ(ended(), 0);
}

TEST_F(Supervision, OutputsAreKeptApartAndBounded) {
  std::ofstream(path("talker.out")) << std::string(10'000'001, 'x');
  Program talker = script("talker", "echo to standard output; echo and to the other >&2; exit 0");
  talker.ends_all = true;
  start({waiting("one"), talker});
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(std::filesystem::file_size(path("talker.out.old")), 10'000'001u);
  const auto text = lines(path("talker.out"));
  ASSERT_EQ(text.size(), 3u);
  EXPECT_THAT(text[0], HasSubstr("-- started 2"));
  EXPECT_EQ(text[1], "to standard output");
  EXPECT_EQ(text[2], "and to the other");
  EXPECT_EQ(tools::last_line(path("talker.out")), "and to the other");
  EXPECT_EQ(tools::last_line(path("one.out")), "");
  EXPECT_EQ(tools::last_line(path("none.out")), "");
}

TEST_F(Supervision, AnOutputThatCannotBeWrittenEndsWhatHadBegun) {
  std::filesystem::create_directories(path("two.out"));
  start({waiting("one"), waiting("two")});
  EXPECT_EQ(ended(), 97);
  EXPECT_THAT(read(path("said")), HasSubstr("two.out: cannot be written"));
  if (std::filesystem::exists(path("one.pids"))) {
    EXPECT_FALSE(runs(process("one")));
  }
}

TEST_F(Supervision, WithTheMonitorOnTheScreenNothingElseIsWrittenThere) {
  options.quiet = true;
  Program monitor = waiting("monitor");
  monitor.foreground = true;
  start({monitor,
         script("bad", "echo x >>$F/starts; echo why >&2; [ $(wc -l <$F/starts) -lt 3 ]; exit $((1 + $?))")});
  EXPECT_EQ(ended(), 1);
  const auto said = lines(path("said"));
  ASSERT_EQ(said.size(), 1u) << "only the last words, when the screen is free again";
  EXPECT_THAT(said[0], HasSubstr("bad cannot be started (exit code 2: why)"));
  EXPECT_THAT(read(path("up.out")), HasSubstr("bad ended (exit code 1: why), starting it again"));
}

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
