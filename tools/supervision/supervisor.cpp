// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/supervisor.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>

#include "supervision/heard_lines.hpp"
#include "supervision/process_state.hpp"
#include "supervision/program_files.hpp"
#include "supervision/program_signals.hpp"
#include "supervision/reports.hpp"
#include "supervision/spawn.hpp"
#include "supervision/terminal_modes.hpp"

namespace egocal::tools {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// The time between two questions for what is still awaited: people do not see it, and it costs nothing.
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
  std::chrono::nanoseconds processor{0};  ///< that it had had when its silence was looked at last
};

std::string ending(int status) {
  if (WIFSIGNALED(status)) return fmt::format("killed by signal {}", WTERMSIG(status));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

bool has_foreground(const std::vector<Program>& programs) {
  return std::any_of(programs.begin(), programs.end(),
                     [](const Program& program) { return program.foreground; });
}

class Supervisor {
 public:
  Supervisor(const std::vector<Program>& programs, const SupervisorOptions& options)
      : options_(options), signals_(has_foreground(programs)) {
    for (const Program& program : programs) children_.push_back({program, Restarts(options.restarts)});
    if (has_foreground(programs)) terminal_.emplace();
  }
  ~Supervisor() { reports_.end(); }  // before a signal that waits can end us: signals_ is there until then
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int run() {
    // all of them before the first program: a folder that is gone once one runs ends nothing
    for (Child& child : children_) child.first_output = files_.open_output_of(child.program, false);
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
      // before the time of the last status, which ends an announcement (BusWatch::Shared::heard)
      const milliseconds announced =
          options_.may_be_silent && child.pid > 0 ? options_.may_be_silent(child.pid) : milliseconds(0);
      const std::optional<milliseconds> since = heard_ago(child);
      const milliseconds counted = without_waiting_for_a_core(child.pid, passed, child.processor);
      if (child.program.foreground || !since || computes_as_announced(child, *since, announced)) continue;
      const std::string& name = child.program.name;
      switch (child.silence.look(*since, counted, any_heard, options_.silence)) {
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

  /// Whether a silent process computes as it has announced. A process that is stopped meanwhile, or waits for
  /// something, hangs as others do.
  bool computes_as_announced(const Child& child, milliseconds silent, milliseconds announced) const {
    if (silent < options_.silence.silent || silent > announced) return false;
    const Activity doing = activity(child.pid);
    return doing == Activity::computes || doing == Activity::disk;
  }

  Work work() const {
    Work work;
    for (const Child& child : children_)
      if (!child.program.foreground) add_work_of(child.pid, work);
    if (options_.counts_awaited) add_work_of(options_.counts_awaited(), work);
    return work;
  }

  /// Whether to wait on for answers after a log's end.
  bool waits_for_answers(Clock::time_point now) {
    const int awaited = options_.awaited && !wanted_at_once_ ? options_.awaited() : 0;
    if (awaited > 0 && !last_answers_.begun())
      reports_.report(
          fmt::format("the log has ended; pairs whose answer or verdict is still awaited: {}", awaited));
    end_at_ = now + look_again;
    const bool waits = last_answers_.wait_on(awaited, work(), now);
    if (const std::optional<Waited> waited = waits ? last_answers_.to_report() : std::nullopt)
      reports_.report(in_words(awaited, *waited));
    if (!waits && awaited > 0)
      reports_.report(
          fmt::format("no more answers come; pairs without a last answer or verdict: {}", awaited));
    return waits;
  }

  void start(Child& child) {
    const int output = child.has_started ? files_.open_output_of(child.program, true) : child.first_output;
    child.started = awake();
    child.pid = spawn(child.program, files_.command_of(child.program, child.has_started), output,
                      signals_.mask_of_programs());
    const int reason = errno;
    if (output >= 0) close(output);
    child.has_started = true;
    // too many processes, or no memory, for the moment
    if (child.pid < 0) {
      child.restarts.not_started();
      start_again(child, std::string("fork: ") + std::strerror(reason));
    }
  }

  /// Waits until a signal comes or something is to be done by the clock.
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
    pollfd waiting[] = {{signals_.descriptor(), POLLIN, 0}, {lines_.descriptor(), POLLIN, 0}};
    poll(waiting, std::size(waiting), static_cast<int>(std::clamp<long long>(left + 1, 0, 1000)));
    if (waiting[1].revents != 0) report_lines();
    while (const std::optional<signalfd_siginfo> info = signals_.next())
      if (info->ssi_signo == SIGTSTP) {
        suspend(info->ssi_code == SI_KERNEL);
      } else if (info->ssi_signo != SIGCHLD && !ending_) {
        // a key of the terminal has reached those in the foreground already
        const bool by_key = info->ssi_code == SI_KERNEL && info->ssi_signo == SIGINT;
        end_all(info->ssi_signo == SIGINT ? SIGINT : SIGTERM, by_key);
      }
    reap();
  }

  void report_lines() {
    for (const std::string& line : lines_.read()) reports_.report(line);
    if (lines_.descriptor() >= 0) return;
    const std::optional<int> again = options_.lines_again ? options_.lines_again() : std::nullopt;
    lines_ = HeardLines(again.value_or(-1));
    reports_.report(again ? "the process that listens to the bus has ended; it is started again"
                          : "the process that listens to the bus has ended: nothing that hangs, errs or is "
                            "not answered is reported any more");
  }

  /// Stops this process, after Ctrl-Z, or SIGTSTP from somebody.
  void suspend(bool by_key) {
    std::vector<pid_t> foreground;
    for (const Child& child : children_)
      if (child.program.foreground && child.pid > 0) foreground.push_back(child.pid);
    stop_until_continued(foreground, by_key);
  }

  /// Notes which programs have ended. Our own programs only: who has forked another child (BusWatch) still
  /// has its pid, which must stay that child's until it asks for its end.
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
        reports_.report(
            fmt::format("{} cannot be started ({}){}", child.program.name, reason(child, status),
                        options_.output_dir.empty() ? "" : ", see " + files_.output_file(child.program)),
            true);
        failed_ = true;
        end_all(SIGTERM, false);
        return;
      case Restarts::Next::again:
        start_again(child, reason(child, status));
        return;
    }
  }

  /// Lets a program start again after the pause that was decided.
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

  /// How a program ended, and its last line of output, unless somebody killed it, whatever it had said.
  std::string reason(const Child& child, int status) const {
    const bool killed = WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
    const std::string said = killed ? "" : files_.last_line_of(child.program);
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

  SupervisorOptions options_;
  ProgramSignals signals_;
  std::vector<Child> children_;
  Clock::time_point looked_at_ = Clock::now(), awake_ = looked_at_;  ///< see awake()
  Clock::time_point watched_at_ = awake_;
  Reports reports_{options_.output_dir, options_.quiet};
  ProgramFiles files_{options_.output_dir, reports_};
  std::optional<TerminalModes> terminal_;  ///< where a program has the terminal
  HeardLines lines_{options_.lines};
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
