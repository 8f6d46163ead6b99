// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/supervisor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct Child {
  Program program;
  pid_t pid = -1;  ///< -1: not running
  Clock::time_point started{}, start_at{};
  milliseconds back_off{0};
  int quick_deaths = 0;
  bool finished = false;  ///< ended as it should
};

/// In the child, between fork and exec: only what is safe there.
[[noreturn]] void become(const Program& program, char* const* arguments, int output,
                         const sigset_t& old_mask) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // whatever happens to us, nothing is left behind
  sigprocmask(SIG_SETMASK, &old_mask, nullptr);
  if (!program.foreground) {
    if (output >= 0) {
      dup2(output, STDOUT_FILENO);
      dup2(output, STDERR_FILENO);
    }
    const int null = open("/dev/null", O_RDONLY);
    if (null >= 0) dup2(null, STDIN_FILENO);
  }
  execv(arguments[0], arguments);
  constexpr char text[] = "cannot be started\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(126);
  _exit(127);
}

std::string ending(int status) {
  if (WIFSIGNALED(status)) return fmt::format("killed by signal {}", WTERMSIG(status));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

class Supervisor {
 public:
  Supervisor(const std::vector<Program>& programs, const SupervisorOptions& options) : options_(options) {
    for (const Program& program : programs) {
      Child child;
      child.program = program;
      children_.push_back(child);
    }
    sigset_t mask;
    sigemptyset(&mask);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGHUP}) sigaddset(&mask, signal);
    sigprocmask(SIG_BLOCK, &mask, &old_mask_);
    signals_ = signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    if (signals_ < 0) throw Error(std::string("signalfd: ") + std::strerror(errno));
  }
  ~Supervisor() {
    close(signals_);
    sigprocmask(SIG_SETMASK, &old_mask_, nullptr);
  }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int run() {
    while (!ending_ || any_running()) {
      const Clock::time_point now = Clock::now();
      if (ending_) {
        if (now >= kill_at_) end_all(SIGKILL);
      } else {
        for (Child& child : children_)
          if (child.pid < 0 && !child.finished && now >= child.start_at) start(child);
        if (end_at_ && now >= *end_at_) end_all(SIGTERM);
      }
      wait();
    }
    return failed_ ? 1 : 0;
  }

 private:
  void start(Child& child) {
    int output = -1;
    if (!options_.output_dir.empty()) {
      output = open(output_file(child).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
      if (output < 0) throw error_at(output_file(child), 0, "", "cannot be written");
    }
    std::vector<char*> arguments;
    for (std::string& argument : child.program.command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    child.pid = fork();
    if (child.pid == 0) become(child.program, arguments.data(), output, old_mask_);
    if (output >= 0) close(output);
    if (child.pid < 0) throw Error(std::string("fork: ") + std::strerror(errno));
    child.started = Clock::now();
  }

  /// Until a signal comes or something is to be done by the clock.
  void wait() {
    Clock::time_point until = Clock::now() + std::chrono::seconds(1);
    if (ending_) {
      until = std::min(until, kill_at_);
    } else {
      if (end_at_) until = std::min(until, *end_at_);
      for (const Child& child : children_)
        if (child.pid < 0 && !child.finished) until = std::min(until, child.start_at);
    }
    const auto left = std::chrono::duration_cast<milliseconds>(until - Clock::now()).count();
    pollfd waiting{signals_, POLLIN, 0};
    poll(&waiting, 1, static_cast<int>(std::clamp<long long>(left + 1, 0, 1000)));
    signalfd_siginfo info;
    while (read(signals_, &info, sizeof info) == static_cast<ssize_t>(sizeof info))
      if (info.ssi_signo != SIGCHLD && !ending_) end_all(static_cast<int>(info.ssi_signo));
    reap();
  }

  void reap() {
    int status = 0;
    for (pid_t pid = waitpid(-1, &status, WNOHANG); pid > 0; pid = waitpid(-1, &status, WNOHANG)) {
      const auto child =
          std::find_if(children_.begin(), children_.end(), [pid](const Child& c) { return c.pid == pid; });
      if (child == children_.end()) continue;
      child->pid = -1;
      if (!ending_) ended(*child, status);
    }
  }

  void ended(Child& child, int status) {
    const bool well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (well && (child.program.ends_all || child.program.foreground)) {
      child.finished = true;
      end_at_ = Clock::now() + (child.program.foreground ? milliseconds(0) : options_.settle);
      return;
    }
    const bool quick = Clock::now() - child.started < std::chrono::seconds(1);
    const bool wrong_usage = WIFEXITED(status) && WEXITSTATUS(status) == 2;
    child.quick_deaths = quick ? child.quick_deaths + 1 : 0;
    if (child.quick_deaths >= options_.most_quick_deaths || wrong_usage) {
      fmt::print(stderr, "egocal up: {} cannot be kept alive ({}){}\n", child.program.name, ending(status),
                 options_.output_dir.empty() ? "" : ", see " + output_file(child));
      failed_ = true;
      end_all(SIGTERM);
      return;
    }
    child.back_off = quick
                         ? std::clamp(2 * child.back_off, options_.first_back_off, options_.longest_back_off)
                         : options_.first_back_off;
    child.start_at = Clock::now() + child.back_off;
    fmt::print(stderr, "egocal up: {} ended ({}), starting it again in {} ms\n", child.program.name,
               ending(status), child.back_off.count());
  }

  void end_all(int signal) {
    for (const Child& child : children_)
      if (child.pid > 0) kill(child.pid, signal);
    kill_at_ = Clock::now() + std::chrono::seconds(3);
    ending_ = true;
  }

  bool any_running() const {
    return std::any_of(children_.begin(), children_.end(), [](const Child& child) { return child.pid > 0; });
  }
  std::string output_file(const Child& child) const {
    return options_.output_dir + "/" + child.program.name + ".out";
  }

  SupervisorOptions options_;
  std::vector<Child> children_;
  sigset_t old_mask_{};
  int signals_ = -1;
  std::optional<Clock::time_point> end_at_;
  Clock::time_point kill_at_{};
  bool ending_ = false, failed_ = false;
};

}  // namespace

int supervise(const std::vector<Program>& programs, const SupervisorOptions& options) {
  return Supervisor(programs, options).run();
}

}  // namespace egocal::tools
