// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that fail, hang, or are ended: the supervisor with small scripts.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <thread>

#include "egocal/error.hpp"
#include "supervised.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"
#include "support/child_process.hpp"
#include "support/paths.hpp"

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
using ::testing::Not;
using tools::Program;

// Where several users write, such as /tmp, a folder of that name may be somebody else's.
TEST_F(Supervision, APrivateFolderIsNobodyElses) {
  tools::require_private_folder(path("new"));
  tools::require_private_folder(path("new"));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(path("new")).permissions(), perms::owner_all);
  std::filesystem::create_directory(path("open"));
  std::filesystem::permissions(path("open"), perms::all);
  std::filesystem::create_directory_symlink(path("new"), path("link"));
  std::ofstream(path("file")) << "";
  for (const char* name : {"open", "link", "file"})
    EXPECT_THROW(tools::require_private_folder(path(name)), Error) << name;
  EXPECT_THROW(tools::require_private_folder(path("none/new")), Error);
}

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

TEST_F(Supervision, AnOutputFolderThatIsGoneEndsNothing) {
  options.output_dir = path("out");
  std::filesystem::create_directories(path("out"));
  start({waiting("one"), waiting("two")});
  process("two");
  std::filesystem::remove_all(path("out"));
  send_signal(process("one"), SIGKILL);
  process("one", 2);
  EXPECT_TRUE(std::filesystem::exists(path("out/one.out"))) << "it is made again";
  // a name that cannot be written: by root, too
  std::filesystem::remove(path("out/one.out"));
  std::filesystem::create_directories(path("out/one.out"));
  send_signal(process("one", 2), SIGKILL);
  EXPECT_TRUE(runs(process("one", 3)));
  EXPECT_TRUE(runs(process("two")));
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")), HasSubstr("one.out: cannot be written"));
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

TEST_F(Supervision, LinesOfOthersAreReported) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
  options.lines = ends[0];
  start({waiting("one")});
  process("one");
  ASSERT_EQ(write(ends[1], "first\nsec", 9), 9);
  EXPECT_TRUE(until([&] { return lines(path("said")).size() == 1; }));
  ASSERT_EQ(write(ends[1], "ond\n", 4), 4);
  EXPECT_TRUE(until([&] { return lines(path("said")).size() == 2; }));
  EXPECT_EQ(lines(path("said")), (std::vector<std::string>{"egocal up: first", "egocal up: second"}));
  close(ends[1]);
  close(ends[0]);
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
}

bool holds_back(pid_t pid, int signal) {
  for (const std::string& line : lines("/proc/" + std::to_string(pid) + "/status"))
    if (line.starts_with("SigBlk:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  return false;
}

bool echoes(int terminal) {
  struct termios modes {};
  return tcgetattr(terminal, &modes) == 0 && (modes.c_lflag & ECHO) != 0;
}

TEST_F(Supervision, AKilledMonitorLeavesTheTerminalAsItWas) {
  int master = -1;
  Program monitor =
      script("monitor", "echo $$ >>$F/monitor.pids; stty raw -echo; echo >>$F/raw; exec sleep 100");
  monitor.foreground = true;
  pid = forkpty(&master, nullptr, nullptr, nullptr);
  if (pid == 0) _exit(tools::supervise({monitor}, options));
  const pid_t first = process("monitor");
  ASSERT_TRUE(until([&] { return lines(path("raw")).size() == 1; }));
  ASSERT_FALSE(echoes(master));
  send_signal(first, SIGKILL);
  const pid_t second = process("monitor", 2);
  ASSERT_TRUE(until([&] { return lines(path("raw")).size() == 2; }));
  send_signal(second, SIGKILL);
  EXPECT_TRUE(until([&] { return echoes(master); }));
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_TRUE(echoes(master));
  close(master);
}

// Whatever its speed, the program in front has stopped once when the shell goes on, and it is continued with
// us.
TEST_F(Supervision, CtrlZWaitsUntilTheTerminalIsGivenBack) {
  int master = -1;
  Program slow = script("slow",
                        "trap 'sleep 0.1; echo >>$F/given_back; kill -STOP $$; echo >>$F/continued' TSTP\n"
                        "echo $$ >>$F/slow.pids\nwhile :; do :; done");
  slow.foreground = true;
  // a shell between us, as a process group without one cannot be stopped
  const pid_t shell = forkpty(&master, nullptr, nullptr, nullptr);
  if (shell == 0) {
    const pid_t job = fork();
    if (job == 0) {
      setpgid(0, 0);
      signal(SIGTTOU, SIG_IGN);
      tcsetpgrp(STDIN_FILENO, getpid());
      signal(SIGTTOU, SIG_DFL);
      _exit(tools::supervise({slow}, options));
    }
    for (int state = 0; waitpid(job, &state, WUNTRACED) == job;) {
      if (!WIFSTOPPED(state)) _exit(WIFEXITED(state) ? WEXITSTATUS(state) : 1);
      std::ofstream(path("stopped"), std::ios::app) << std::filesystem::exists(path("given_back")) << "\n";
      kill(-job, SIGCONT);  // fg
    }
    _exit(1);
  }
  process("slow");
  const auto jobs = test::children(shell);
  ASSERT_EQ(jobs.size(), 1u);
  for (std::size_t i = 1; i <= 2; ++i) {
    // the job runs again
    ASSERT_TRUE(until([&] { return holds_back(jobs[0].first, SIGTSTP); })) << i;
    ASSERT_EQ(write(master, "\x1a", 1), 1);
    ASSERT_TRUE(until([&] { return lines(path("continued")).size() == i; })) << i;
    EXPECT_EQ(lines(path("stopped")), std::vector<std::string>(i, "1"));
  }
  ASSERT_EQ(write(master, "\x03", 1), 1);
  int state = 0;
  EXPECT_TRUE(until([&] { return waitpid(shell, &state, WNOHANG) == shell; }));
  close(master);
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

TEST_F(Supervision, AnOutputThatCannotBeWrittenIsReportedBeforeAnythingStarts) {
  std::filesystem::create_directories(path("two.out"));
  start({waiting("one"), waiting("two")});
  EXPECT_EQ(ended(), 97);
  EXPECT_THAT(read(path("said")), HasSubstr("two.out: cannot be written"));
  EXPECT_FALSE(std::filesystem::exists(path("one.pids")));
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
}  // namespace egocal::test_supervision
