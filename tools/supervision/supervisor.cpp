// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/supervisor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>

#include "egocal/error.hpp"
#include "supervision/output_file.hpp"
#include "supervision/process_state.hpp"
#include "supervision/reports.hpp"
#include "supervision/spawn.hpp"
#include "supervision/terminal_modes.hpp"

namespace egocal::tools {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Between two questions for what is still awaited: people do not see it, and it costs nothing.
constexpr milliseconds look_again{100};
/// Two turns of the supervisor are no farther apart, unless it was stopped.
constexpr milliseconds longest_turn{2000};

struct Child {
  Program program;
  Restarts restarts;
  pid_t pid = -1;         ///< -1: not running
  int first_output = -1;  ///< its output until it has started; -1: where ours goes
  Clock::time_point started{}, start_at{};
  bool has_started = false;  ///< at least once
  bool finished = false;     ///< ended as it should
  std::string reported{};    ///< how it ended when that was reported last,
  Clock::time_point reported_at{};
  Silence silence{};
};

std::string ending(int status) {
  if (WIFSIGNALED(status)) return fmt::format("killed by signal {}", WTERMSIG(status));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

class Supervisor {
 public:
  Supervisor(const std::vector<Program>& programs, const SupervisorOptions& options) : options_(options) {
    for (const Program& program : programs) children_.push_back({program, Restarts(options.restarts)});
    sigset_t mask;
    sigemptyset(&mask);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGHUP}) sigaddset(&mask, signal);
    if (std::any_of(programs.begin(), programs.end(),
                    [](const Program& program) { return program.foreground; })) {
      terminal_.emplace();
      sigaddset(&mask, SIGTSTP);
    }
    sigprocmask(SIG_BLOCK, &mask, &old_mask_);
    // the caller may hold signals back for us
    programs_mask_ = old_mask_;
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGHUP, SIGTSTP}) sigdelset(&programs_mask_, signal);
    signals_ = signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    if (signals_ < 0) throw Error(std::string("signalfd: ") + std::strerror(errno));
  }
  ~Supervisor() {
    close(signals_);
    reports_.end();  // before a signal that waits can end us
    sigprocmask(SIG_SETMASK, &old_mask_, nullptr);
  }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int run() {
    // all of them before the first program: a folder that is gone once one runs ends nothing
    for (Child& child : children_) child.first_output = output_of(child);
    try {
      while (!ending_ || any_running()) turn();
    } catch (...) {
      end_all(SIGTERM, false);
      while (any_running()) turn();
      throw;
    }
    return failed_ ? 1 : 0;
  }

 private:
  /// The clock without the time in which this process was stopped: its turns are a second apart at most.
  Clock::time_point awake() {
    const Clock::time_point now = Clock::now();
    awake_ += std::min<Clock::duration>(now - looked_at_, longest_turn);
    looked_at_ = now;
    return awake_;
  }

  void turn() {
    const Clock::time_point now = awake();
    if (ending_) {
      if (now >= kill_at_) kill_all();
    } else {
      for (Child& child : children_)
        if (child.pid < 0 && !child.finished && now >= child.start_at) start(child);
      if (end_at_ && now >= *end_at_ && !waits_for_answers(now)) end_all(SIGTERM, false);
      if (options_.heard_ago) watch_silence(now);
    }
    wait();
  }

  void watch_silence(Clock::time_point now) {
    const auto heard_ago = [this](const Child& child) {
      return child.pid > 0 ? options_.heard_ago(child.pid) : std::nullopt;
    };
    const milliseconds heard = options_.silence.heard;
    const bool any_heard = std::any_of(children_.begin(), children_.end(), [&](const Child& child) {
      return heard_ago(child).value_or(heard) < heard;
    });
    const auto passed = std::chrono::duration_cast<milliseconds>(now - watched_at_);
    watched_at_ = now;
    for (Child& child : children_) {
      const std::optional<milliseconds> since = heard_ago(child);
      if (child.program.foreground || !since || computes_as_announced(child, *since)) continue;
      const std::string& name = child.program.name;
      switch (child.silence.look(*since, passed, any_heard, options_.silence)) {
        case Silence::Next::nothing:
          break;
        case Silence::Next::report_heard:
          reports_.report(fmt::format("{} is heard again", name));
          break;
        case Silence::Next::report_and_continue:
          reports_.report(
              fmt::format("{} is silent for {:.1f} s: it hangs or was stopped; it is continued, and "
                          "killed where that does not help",
                          name, 1e-3 * static_cast<double>(since->count())));
          kill(child.pid, SIGCONT);
          break;
        case Silence::Next::kill:
          reports_.report(fmt::format("{} still hangs and is killed", name));
          kill(child.pid, SIGKILL);
          break;
      }
    }
  }

  /// One that is stopped meanwhile, or waits for something, hangs as others do.
  bool computes_as_announced(const Child& child, milliseconds silent) const {
    return options_.may_be_silent && silent >= options_.silence.silent &&
           silent <= options_.may_be_silent(child.pid) && computes(child.pid);
  }

  bool any_has_work() const {
    return std::any_of(children_.begin(), children_.end(), [](const Child& child) {
      return child.pid > 0 && !child.program.foreground && has_work(child.pid);
    });
  }

  /// After a log's end.
  bool waits_for_answers(Clock::time_point now) {
    const int awaited = options_.awaited && !wanted_at_once_ ? options_.awaited() : 0;
    if (awaited > 0 && !last_answers_.begun())
      reports_.report(
          fmt::format("the log has ended; pairs whose answer or verdict is still awaited: {}", awaited));
    end_at_ = now + look_again;
    const bool waits = last_answers_.wait_on(awaited, any_has_work(), now);
    if (!waits && awaited > 0)
      reports_.report(
          fmt::format("no more answers come; pairs without a last answer or verdict: {}", awaited));
    return waits;
  }

  void start(Child& child) {
    const int output = child.has_started ? output_of(child) : child.first_output;
    child.started = awake();
    child.pid = spawn(child.program, command_of(child), output, programs_mask_);
    const int reason = errno;
    if (output >= 0) close(output);
    child.has_started = true;
    // too many processes, or no memory, for the moment
    if (child.pid < 0) {
      child.restarts.not_started();
      start_again(child, std::string("fork: ") + std::strerror(reason));
    }
  }

  /// Without its state file where the folder is gone and cannot be made: a process that cannot lock its state
  /// does not begin, and the drive goes on.
  std::vector<std::string> command_of(const Child& child) {
    std::vector<std::string> command = child.program.command;
    const auto option = std::find(command.begin(), command.end(), "--state");
    if (!child.has_started || option == command.end() || option + 1 == command.end()) return command;
    const std::filesystem::path folder = std::filesystem::absolute(*(option + 1)).parent_path();
    std::error_code none;
    std::filesystem::create_directories(folder, none);
    if (std::filesystem::is_directory(folder, none)) return command;
    reports_.report(fmt::format(
        "{}: is gone and cannot be made again; {} starts without the state file there, and saves nothing",
        folder.string(), child.program.name));
    command.erase(option, option + 2);
    return command;
  }

  /// -1: where ours goes. A disk that has become full or a folder that is gone must not end what runs.
  int output_of(const Child& child) {
    if (options_.output_dir.empty() || child.program.foreground) return -1;
    try {
      if (child.has_started) {
        std::error_code none;
        std::filesystem::create_directories(options_.output_dir, none);
      }
      return open_output(output_file(child));
    } catch (const Error& error) {
      if (!child.has_started) throw;
      reports_.report(std::string(error.what()) + "; its output is not kept");
      return open("/dev/null", O_WRONLY | O_CLOEXEC);
    }
  }

  /// Until a signal comes or something is to be done by the clock.
  void wait() {
    Clock::time_point until = awake() + std::chrono::seconds(1);
    if (ending_) {
      until = std::min(until, kill_at_);
    } else {
      if (end_at_) until = std::min(until, *end_at_);
      for (const Child& child : children_)
        if (child.pid < 0 && !child.finished) until = std::min(until, child.start_at);
    }
    const auto left = std::chrono::duration_cast<milliseconds>(until - awake()).count();
    pollfd waiting[] = {{signals_, POLLIN, 0}, {lines_, POLLIN, 0}};
    poll(waiting, std::size(waiting), static_cast<int>(std::clamp<long long>(left + 1, 0, 1000)));
    if (waiting[1].revents != 0) report_lines();
    signalfd_siginfo info;
    while (read(signals_, &info, sizeof info) == static_cast<ssize_t>(sizeof info))
      if (info.ssi_signo == SIGTSTP) {
        suspend(info.ssi_code == SI_KERNEL);
      } else if (info.ssi_signo != SIGCHLD && !ending_) {
        // a key of the terminal has reached those in the foreground already
        const bool by_key = info.ssi_code == SI_KERNEL && info.ssi_signo == SIGINT;
        end_all(info.ssi_signo == SIGINT ? SIGINT : SIGTERM, by_key);
      }
    reap();
  }

  void report_lines() {
    char part[4096];
    const ssize_t n = read(lines_, part, sizeof part);
    if (n > 0) {
      said_.append(part, static_cast<std::size_t>(n));
      for (std::size_t end = said_.find('\n'); end != std::string::npos; end = said_.find('\n')) {
        reports_.report(said_.substr(0, end));
        said_.erase(0, end + 1);
      }
    } else if (n == 0 || errno != EAGAIN) {
      const std::optional<int> again = options_.lines_again ? options_.lines_again() : std::nullopt;
      lines_ = again.value_or(-1);
      reports_.report(again ? "the process that listens to the bus has ended; it is started again"
                            : "the process that listens to the bus has ended: nothing that hangs, errs or is "
                              "not answered is reported any more");
    }
  }

  /// Ctrl-Z, or SIGTSTP from somebody.
  void suspend(bool by_key) {
    std::vector<pid_t> foreground;
    for (const Child& child : children_)
      if (child.program.foreground && child.pid > 0) foreground.push_back(child.pid);
    stop_until_continued(foreground, by_key);
  }

  /// Our own programs only: who has forked another child (BusWatch) still has its pid, which must stay that
  /// child's until it asks for its end.
  void reap() {
    for (Child& child : children_) {
      int status = 0;
      if (child.pid < 0 || waitpid(child.pid, &status, WNOHANG) != child.pid) continue;
      child.pid = -1;
      child.silence = {};
      if (child.program.foreground) terminal_->restore();
      if (!ending_) ended(child, status);
    }
  }

  void ended(Child& child, int status) {
    const auto lived = std::chrono::duration_cast<milliseconds>(awake() - child.started);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    switch (child.restarts.ended(child.program, code, lived)) {
      case Restarts::Next::finished:
        child.finished = true;
        if (child.program.foreground && options_.foreground_ended) options_.foreground_ended();
        wanted_at_once_ = wanted_at_once_ || child.program.foreground;
        end_at_ = awake() + (wanted_at_once_ ? milliseconds(0) : options_.settle);
        if (options_.awaited) static_cast<void>(options_.awaited());  // from now on
        return;
      case Restarts::Next::hopeless:
        reports_.report(fmt::format("{} cannot be started ({}){}", child.program.name, reason(child, status),
                                    options_.output_dir.empty() ? "" : ", see " + output_file(child)),
                        true);
        failed_ = true;
        end_all(SIGTERM, false);
        return;
      case Restarts::Next::again:
        start_again(child, reason(child, status));
        return;
    }
  }

  /// After the pause that was decided.
  void start_again(Child& child, const std::string& reason) {
    const Clock::time_point now = awake();
    child.start_at = now + child.restarts.pause();
    if (child.reported == reason && child.restarts.pauses_longest() &&
        now - child.reported_at < options_.repeat_report)
      return;
    child.reported = reason;
    child.reported_at = now;
    reports_.report(fmt::format("{} ended ({}), starting it again in {} ms", child.program.name, reason,
                                child.restarts.pause().count()));
  }

  /// How it ended, and its last line of output, unless somebody killed it, whatever it had said.
  std::string reason(const Child& child, int status) const {
    const bool killed = WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
    const std::string said = options_.output_dir.empty() || child.program.foreground || killed
                                 ? ""
                                 : last_line(output_file(child));
    return ending(status) + (said.empty() ? "" : ": " + said);
  }

  void end_all(int signal, bool foreground_knows) {
    for (const Child& child : children_)
      if (child.pid > 0 && !(child.program.foreground && foreground_knows)) kill(child.pid, signal);
    kill_at_ = awake() + options_.patience;
    ending_ = true;
  }

  void kill_all() {
    for (const Child& child : children_) {
      if (child.pid <= 0) continue;
      reports_.report(fmt::format("{} did not end and is killed", child.program.name));
      kill(child.pid, SIGKILL);
    }
    kill_at_ = awake() + options_.patience;
  }

  bool any_running() const {
    return std::any_of(children_.begin(), children_.end(), [](const Child& child) { return child.pid > 0; });
  }
  std::string output_file(const Child& child) const {
    return options_.output_dir + "/" + child.program.name + ".out";
  }

  SupervisorOptions options_;
  std::vector<Child> children_;
  Clock::time_point looked_at_ = Clock::now(), awake_ = looked_at_;  ///< see awake()
  Clock::time_point watched_at_ = awake_;
  sigset_t old_mask_{}, programs_mask_{};
  int signals_ = -1;
  Reports reports_{options_.output_dir, options_.quiet};
  std::optional<TerminalModes> terminal_;  ///< where a program has the terminal
  int lines_ = options_.lines;
  std::string said_;  ///< the beginning of a line
  std::optional<Clock::time_point> end_at_;
  bool wanted_at_once_ = false;  ///< the user has closed the monitor
  LastAnswers last_answers_{options_.last_answers};
  Clock::time_point kill_at_{};
  bool ending_ = false, failed_ = false;
};

}  // namespace

int supervise(const std::vector<Program>& programs, const SupervisorOptions& options) {
  return Supervisor(programs, options).run();
}

}  // namespace egocal::tools
