// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/process_state.hpp"

#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

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

/// Processor time of a process since its start; 0 where it has ended.
std::chrono::nanoseconds processor_time(pid_t pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

Activity activity_of_thread(const std::filesystem::path& file) {
  std::ifstream stat(file);
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(") ");
  if (name_end == std::string::npos || name_end + 2 >= text.size()) return Activity::waits;
  switch (text[name_end + 2]) {
    case 'R':
      return Activity::computes;
    case 'D':
      return Activity::disk;
    case 'T':
    case 't':
      return Activity::stopped;
    default:
      return Activity::waits;
  }
}

}  // namespace

Activity activity(pid_t pid) {
  std::error_code gone;  // a process may end meanwhile
  Activity most = Activity::waits;
  const std::string threads = "/proc/" + std::to_string(pid) + "/task";
  for (std::filesystem::directory_iterator thread(threads, gone), end; !gone && thread != end;
       thread.increment(gone)) {
    const Activity doing = activity_of_thread(thread->path() / "stat");
    if (doing == Activity::computes) return doing;  // another one may wait for its result
    if (most == Activity::waits) most = doing;
  }
  return most;
}

void add_work_of(pid_t pid, Work& work) {
  if (pid <= 0) return;
  const Activity doing = activity(pid);
  work.computes = work.computes || doing == Activity::computes;
  work.held = work.held || doing == Activity::disk || doing == Activity::stopped;
  work.processor += processor_time(pid);
}

std::chrono::milliseconds without_waiting_for_a_core(pid_t pid, std::chrono::milliseconds passed,
                                                     std::chrono::nanoseconds& processor) {
  if (pid <= 0) return passed;
  const auto before = std::exchange(processor, processor_time(pid));
  if (activity(pid) != Activity::computes) return passed;
  const auto used = std::chrono::duration_cast<std::chrono::milliseconds>(processor - before);
  return std::clamp(used, std::chrono::milliseconds(0), passed);
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
