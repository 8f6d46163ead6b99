// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The player or the monitor has ended, and the last answers are awaited: small scripts under the supervisor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "supervised.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::test_supervision_end {
namespace {

using namespace std::chrono_literals;
using test::lines;
using test::read;
using test::Supervision;
using ::testing::HasSubstr;
using tools::Program;

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
  options.last_answers.stall = 300ms;
  options.awaited = [left = 6]() mutable { return left > 0 ? left-- : 0; };
  start({waiting("one"), player});
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")), HasSubstr("still awaited: 5"));

  std::filesystem::remove(path("said"));
  options.awaited = [] { return 1; };
  start({waiting("one"), player});
  EXPECT_EQ(ended(), 0) << "what does not come is not waited for";
}

// One diagnosis took more than 5 s: `egocal up` ended with "the last 76.7 s are not judged".
TEST_F(Supervision, AnswersAreAwaitedWhileAProcessComputesOneButNotForEver) {
  Program player = script("player", "exit 0");
  player.ends_all = true;
  options.settle = 0ms;
  options.last_answers.stall = 500ms;
  options.awaited = [this] { return std::filesystem::exists(path("answered")) ? 0 : 1; };
  // about a second on a core of its own, a minute where it gets little of one
  start({waiting("one"), player,
         script("computing",
                "i=0; while [ $i -lt 1000000 ]; do i=$((i+1)); done; echo >$F/answered; "
                "exec sleep 100")});
  EXPECT_EQ(ended(180s), 0);
  EXPECT_TRUE(std::filesystem::exists(path("answered")));

  std::filesystem::remove(path("answered"));
  options.last_answers.longest_stall = 1s;
  start({waiting("one"), player, script("turns in circles", "while :; do :; done")});
  EXPECT_EQ(ended(180s), 0);
  EXPECT_FALSE(std::filesystem::exists(path("answered")));
}

TEST_F(Supervision, AClosedMonitorWaitsForNoAnswers) {
  Program player = script("player", "exit 0");
  player.ends_all = true;
  Program monitor = script("monitor", "sleep 0.5");
  monitor.foreground = true;
  options.last_answers.stall = 1h;
  options.awaited = [] { return 1; };
  start({waiting("one"), player, monitor});
  EXPECT_EQ(ended(), 0);
}

}  // namespace
}  // namespace egocal::test_supervision_end
