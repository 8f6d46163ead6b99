// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that are silent, because they hang, were stopped or compute: small scripts under the supervisor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "supervised.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::test_supervision_silence {
namespace {

using namespace std::chrono_literals;
using test::lines;
using test::read;
using test::runs;
using test::send_signal;
using test::Supervision;
using test::until;
using ::testing::HasSubstr;
using ::testing::Not;

/// The newest process of this name is silent, all others were heard just now.
std::function<std::optional<std::chrono::milliseconds>(pid_t)> silent(const std::string& pids,
                                                                      int processes) {
  return [=](pid_t pid) -> std::optional<std::chrono::milliseconds> {
    const auto all = lines(pids);
    const bool it = static_cast<int>(all.size()) <= processes && !all.empty() && std::stoi(all.back()) == pid;
    return it ? 10s : 10ms;
  };
}

TEST_F(Supervision, WhatHangsIsContinuedAndThenKilled) {
  options.silence.hangs = 5300ms;  // 0.3 s after it was reported
  options.heard_ago = silent(path("hanging.pids"), 1);
  start({waiting("one"), waiting("hanging"),
         script("stopped",
                "echo $$ >>$F/stopped.pids; kill -STOP $$; "
                "echo >>$F/continued; exec sleep 100")});
  const pid_t hanging = process("hanging");
  EXPECT_TRUE(runs(process("hanging", 2)));
  EXPECT_FALSE(runs(hanging));
  EXPECT_FALSE(std::filesystem::exists(path("continued"))) << "it was heard";
  send_signal(process("stopped"), SIGKILL);
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(lines(path("one.pids")).size(), 1u);
  EXPECT_THAT(read(path("said")), HasSubstr("hanging is silent for 10.0 s: it hangs or was stopped"));
  EXPECT_THAT(read(path("said")), HasSubstr("hanging still hangs and is killed"));
  EXPECT_THAT(read(path("said")), HasSubstr("hanging ended (killed by signal 9)"));
}

TEST_F(Supervision, WhatWasStoppedIsContinued) {
  options.heard_ago = silent(path("stopped.pids"), 1);
  start({waiting("one"), script("stopped",
                                "echo $$ >>$F/stopped.pids; kill -STOP $$; echo >>$F/continued; "
                                "exec sleep 100")});
  EXPECT_TRUE(until([&] { return std::filesystem::exists(path("continued")); }));
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
}

// A diagnosis that was short of a core was silent for more than 5 s, and was reported as one that hangs.
TEST_F(Supervision, WhatComputesAsItHasAnnouncedIsLeftAloneButNotWhatIsStopped) {
  options.silence.silent = 500ms;  // of a core that others take as well
  options.silence.hangs = 800ms;
  options.may_be_silent = [this](pid_t asked) {
    const auto late = lines(path("late.pids"));
    return !late.empty() && std::stoi(late.front()) == asked ? 9s : 60s;
  };
  // one that is always heard
  options.heard_ago = [this](pid_t asked) -> std::optional<std::chrono::milliseconds> {
    const auto one = lines(path("one.pids"));
    return !one.empty() && std::stoi(one.front()) == asked ? 10ms : 10s;
  };
  const std::string computes = "echo $$ >>$F/$NAME.pids; while :; do :; done";
  start({waiting("one"), script("computing", "NAME=computing; " + computes),
         script("late", "NAME=late; " + computes),
         script("stopped", "echo $$ >>$F/stopped.pids; kill -STOP $$; echo >>$F/continued; exec sleep 100")});
  const pid_t computing = process("computing");
  EXPECT_TRUE(until([&] { return std::filesystem::exists(path("continued")); }));
  process("late", 2);
  EXPECT_TRUE(runs(computing));
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(lines(path("computing.pids")).size(), 1u);
  EXPECT_THAT(read(path("said")), HasSubstr("late is silent for 10.0 s: it hangs or was stopped"));
  EXPECT_THAT(read(path("said")), HasSubstr("stopped is silent for 10.0 s: it hangs or was stopped"));
  EXPECT_THAT(read(path("said")), Not(HasSubstr("computing is silent")));
}

// Ctrl-Z and fg, or a container that is frozen: the time in which the supervisor did not run is not theirs.
TEST_F(Supervision, WhoWasStoppedTogetherWithTheSupervisorIsNotBlamed) {
  // of the time in which the supervisor was stopped two seconds count; the rest is room for a busy machine
  options.silence.silent = 5000ms;
  options.heard_ago = [this](pid_t asked) -> std::optional<std::chrono::milliseconds> {
    const auto all = lines(path("two.pids"));
    if (all.empty() || std::stoi(all.back()) != asked) return 10ms;
    std::error_code none;
    const auto since = std::filesystem::file_time_type::clock::now() -
                       std::filesystem::last_write_time(path("two.heard"), none);
    return none ? std::chrono::milliseconds(0) : std::chrono::duration_cast<std::chrono::milliseconds>(since);
  };
  start({waiting("one"),
         script("two", "echo $$ >>$F/two.pids; while :; do echo >$F/two.heard; sleep 0.1; done")});
  const pid_t two = process("two");
  send_signal(two, SIGSTOP);
  send_signal(pid, SIGSTOP);
  std::this_thread::sleep_for(6s);
  send_signal(pid, SIGCONT);
  std::this_thread::sleep_for(300ms);
  send_signal(two, SIGCONT);
  std::this_thread::sleep_for(1s);
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(read(path("said")), "");
}

}  // namespace
}  // namespace egocal::test_supervision_silence
