// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/process_state.hpp"

#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

namespace egocal::tools {

namespace {

using Clock = std::chrono::steady_clock;

/// A foreground program has given the terminal back by then.
constexpr std::chrono::milliseconds gives_back{1000};

void wait_until_stopped(pid_t pid) {
  siginfo_t stopped{};
  const Clock::time_point end = Clock::now() + gives_back;
  while (waitid(P_PID, static_cast<id_t>(pid), &stopped, WSTOPPED | WNOHANG) == 0 && stopped.si_pid == 0 &&
         Clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// One of these states, by their letters in /proc.
bool is_in(pid_t pid, std::string_view states) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(") ");
  return name_end != std::string::npos && name_end + 2 < text.size() &&
         states.find(text[name_end + 2]) != std::string_view::npos;
}

}  // namespace

bool has_work(pid_t pid) {
  return is_in(pid, "RDTt");
}

bool computes(pid_t pid) {
  return is_in(pid, "RD");
}

void stop_until_continued(std::span<const pid_t> foreground, bool by_key) {
  for (const pid_t pid : foreground) {
    if (!by_key) kill(pid, SIGTSTP);
    wait_until_stopped(pid);
  }
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTSTP);
  raise(SIGTSTP);
  sigprocmask(SIG_UNBLOCK, &stop, nullptr);  // stops here, until SIGCONT
  sigprocmask(SIG_BLOCK, &stop, nullptr);
  for (const pid_t pid : foreground) kill(pid, SIGCONT);
}

}  // namespace egocal::tools
