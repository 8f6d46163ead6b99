// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The keys and modes of a terminal that processes share: small scripts under the supervisor.
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "supervised.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::test_supervision_terminal {
namespace {

using test::lines;
using test::send_signal;
using test::Supervision;
using test::until;
using tools::Program;

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

}  // namespace
}  // namespace egocal::test_supervision_terminal
