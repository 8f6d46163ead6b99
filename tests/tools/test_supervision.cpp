// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that fail or are ended: the supervisor with small scripts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "supervised.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::test_supervision {
namespace {

using namespace std::chrono_literals;
using test::lines;
using test::read;
using test::runs;
using test::send_signal;
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
  send_signal(pid, SIGTERM);
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
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
}

TEST_F(Supervision, WhatIsKilledIsStartedAgainAndTheOthersGoOn) {
  start({waiting("one"), waiting("two")});
  const pid_t two = process("two");
  send_signal(process("one"), SIGKILL);
  const pid_t again = process("one", 2);
  EXPECT_TRUE(runs(again));
  EXPECT_TRUE(runs(two));
  EXPECT_EQ(lines(path("two.pids")).size(), 1u);
  send_signal(pid, SIGTERM);
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
    send_signal(pid, sent);
    EXPECT_EQ(ended(), 0);
    for (const char* name : {"one", "two"})
      EXPECT_EQ(lines(path(name + std::string(".signals"))), std::vector<std::string>{passed}) << name;
  }
}

TEST_F(Supervision, NothingIsLeftWhenTheSupervisorIsKilled) {
  start({waiting("one"), waiting("two")});
  const pid_t one = process("one"), two = process("two");
  send_signal(pid, SIGKILL);
  EXPECT_EQ(ended(), 128 + SIGKILL);
  EXPECT_TRUE(until([&] { return !runs(one) && !runs(two); }));
  EXPECT_EQ(lines(path("one.signals")), std::vector<std::string>{"TERM"});
}

TEST_F(Supervision, WhatDoesNotEndIsKilled) {
  options.patience = 300ms;
  start({script("deaf", "trap '' TERM INT; echo $$ >>$F/deaf.pids; while :; do sleep 0.05; done")});
  const pid_t deaf = process("deaf");
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_FALSE(runs(deaf));
  EXPECT_THAT(read(path("said")), HasSubstr("deaf did not end and is killed"));
}

// The process that listens to the bus is forked beside the programs: its pid would be another's once it is
// reaped, and gets signals.
TEST_F(Supervision, ChildrenOfOthersAreLeftToThem) {
  Program player = script("player", "sleep 0.5");
  player.ends_all = true;
  pid = fork();
  if (pid == 0) {
    const pid_t other = fork();
    if (other == 0) _exit(7);
    int code = tools::supervise({waiting("one"), player}, options), state = 0;
    if (waitpid(other, &state, 0) != other || !WIFEXITED(state) || WEXITSTATUS(state) != 7) code = 55;
    _exit(code);
  }
  EXPECT_EQ(ended(), 0);
}

}  // namespace
}  // namespace egocal::test_supervision
