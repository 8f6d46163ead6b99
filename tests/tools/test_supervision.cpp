// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that fail, hang, or are ended: the supervisor with small scripts.
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
using test::lines;
using test::read;
using test::runs;
using test::Supervision;
using test::until;
using ::testing::HasSubstr;
using tools::Program;

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

TEST_F(Supervision, AnswersAreAwaitedAfterALogWhileTheyCome) {
  Program player = script("player", "exit 0");
  player.ends_all = true;
  options.stall = 300ms;
  options.awaited = [left = 5]() mutable { return left > 0 ? left-- : 0; };
  start({waiting("one"), player});
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")), HasSubstr("still to be judged: 5"));

  std::filesystem::remove(path("said"));
  options.awaited = [] { return 1; };
  start({waiting("one"), player});
  EXPECT_EQ(ended(), 0) << "what does not come is not waited for";
}

TEST_F(Supervision, AClosedMonitorWaitsForNoAnswers) {
  Program player = script("player", "exit 0");
  player.ends_all = true;
  Program monitor = script("monitor", "sleep 0.5");
  monitor.foreground = true;
  options.stall = 1h;
  options.awaited = [] { return 1; };
  start({waiting("one"), player, monitor});
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

}  // namespace
}  // namespace egocal

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && !egocal::test::enter_network_namespace()) return 1;
  return RUN_ALL_TESTS();
}
