// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/bus_watch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/pair_messages.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "supervision/bus_news.hpp"
#include "supervision/last_motions.hpp"

namespace egocal::tools {

using std::chrono::milliseconds;

std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time) {
  bus::Loop loop(url, {.handle_signals = false, .require_network = false});
  std::optional<std::string> found;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.role == "pairing" && status.state != "ended")
      found = fmt::format("{} (pid {} on {})", bus::printable(status.name, 40), status.pid,
                          bus::printable(status.host, 60));
  });
  const auto end = std::chrono::steady_clock::now() + time;
  auto now = std::chrono::steady_clock::now();
  for (; !found && now < end; now = std::chrono::steady_clock::now()) loop.run_once(end - now);
  // on a computer under load the time has passed while a message waits
  if (!found) loop.run_once({});
  return found;
}

namespace {

struct Pipe {
  Descriptor read, write;
};

Pipe make_pipe(int flags) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | flags) != 0) throw Error(std::string("pipe: ") + std::strerror(errno));
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Begins the text that the listening process sends where there is no outcome: the reason follows.
constexpr char failed = '!';

/// Most processes whose statuses are remembered, ours and others on this host: a limit on memory.
constexpr std::size_t most_processes = 32;

/// Questions, ten a second, after which a listening process that has not counted since was stopped: it counts
/// ten times a second.
constexpr int most_not_counted = 20;

std::int64_t mono_ms() {
  return std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// A listening process that has listened for less has not heard all pairs: pairing sends its newest problems
/// again each second.
constexpr std::int64_t least_heard_ms = 1500;

/// Ends a process, also one that was stopped.
void terminate(pid_t pid) {
  kill(pid, SIGTERM);
  kill(pid, SIGCONT);
}

/// Writes a text. A reader that has gone needs nothing more.
void send(int out, const std::string& text) {
  static_cast<void>(write_all(out, std::as_bytes(std::span(text))));
}

}  // namespace

struct BusWatch::Shared {
  struct Process {
    std::atomic<pid_t> pid{-1};
    std::atomic<std::int64_t> heard_ms{0};
    std::atomic<std::int64_t> announced_s{0};  ///< silence
  };
  std::atomic<int> awaited{0};
  std::atomic<int> asked{0}, counted{0};  ///< questions for it, and the last one that it was counted for
  std::array<Process, most_processes> processes;

  void heard(pid_t pid, std::chrono::seconds announced, std::int64_t now_ms) {
    auto entry = std::find_if(processes.begin(), processes.end(),
                              [pid](const Process& process) { return process.pid == pid; });
    if (entry == processes.end()) {
      entry = std::min_element(processes.begin(), processes.end(),
                               [](const Process& x, const Process& y) { return x.heard_ms < y.heard_ms; });
      entry->pid = -1;
    }
    // announced_silence() is read before silence(): a reader that finds no announcement has seen this status
    entry->heard_ms = now_ms;
    entry->announced_s = announced.count();
    entry->pid = pid;
  }
};

namespace {

/// What the listening process knows.
class Listening {
 public:
  Listening(const bus::Rig& rig, const std::string& url, const BusWatchOptions& options)
      : rig_(rig), options_(options), loop_(url, {.require_network = false}), news_(rig, options.news) {
    answers_.expect_scales(rig);
    for (const bus::PairConfig& pair : rig.pairs)
      bus::subscribe_pair(loop_, pair.a, pair.b,
                          [this]<class Message>(const Message& message, const bus::Arrival& arrival) {
                            answers_.hear(message);
                            if constexpr (std::is_same_v<Message, problem_t>) {
                              last_motions_.hear(message);
                              news_.hear(message, arrival.mono_us);
                            }
                          });
    loop_.subscribe<command_t>(bus::command_channel, [this](const command_t& command, const bus::Arrival&) {
      news_.hear(command, loop_.mono_us());
    });
    for (const bus::Sensor& sensor : rig.sensors)
      loop_.subscribe_bytes(sensor.channel, [this](const bus::Arrival& arrival) {
        news_.hear(arrival.channel, arrival.bytes, arrival.mono_us);
      });
  }
  bus::Loop& loop() { return loop_; }
  Outcome outcome(bus::LogReader& log) const {
    Outcome outcome = outcome_of(rig_, answers_, log_extent(log, rig_), read_until_, options_.outcome);
    if (!outcome.answered) outcome.text = news_.why_nothing();
    return outcome;
  }

  void hear(const status_t& status) {
    news_.hear(status, loop_.mono_us());
    if (status.role == bus::role_name(bus::Role::pairing) &&
        status.state != bus::state_name(bus::State::waiting))
      for (const acknowledgement_t& entry : status.acknowledgements)
        if (read_until_.size() < most_channels || read_until_.contains(entry.channel))
          if (std::exchange(read_until_[entry.channel], entry.utime) != entry.utime) last_motions_.clear();
  }

  /// The log has ended.
  void begin_to_wait() { last_motions_.clear(); }

  int awaited() const {
    return static_cast<int>(
        std::count_if(rig_.pairs.begin(), rig_.pairs.end(), [&](const bus::PairConfig& config) {
          const PairName pair{config.a, config.b};
          return (answers_.best(pair) || answers_.end_of_motions(pair)) &&
                 !(last_motions_.known(pair) && answers_.judged_to_the_end(pair) &&
                   answers_.answered_to_the_end(pair));
        }));
  }

  /// Lines for people.
  std::string news() { return news_.lines(answers_, loop_.mono_us()); }

 private:
  static constexpr std::size_t most_channels = 1000;  // a limit on memory

  const bus::Rig& rig_;
  const BusWatchOptions& options_;
  bus::Loop loop_;
  Answers answers_;
  LastMotions last_motions_;
  ReadUntil read_until_;
  BusNews news_;
};

}  // namespace

void BusWatch::listen(int out, int lines) {
  try {
    // held open, as the player holds it: the log may be moved, removed or recorded on meanwhile
    std::optional<bus::LogReader> reader;
    if (!log_.empty()) reader.emplace(log_);
    Listening listening(rig_, url_, options_);
    bus::Loop& loop = listening.loop();
    loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
      listening.hear(status);
      if (status.host == loop.host()) shared_->heard(status.pid, bus::announced_silence(status), mono_ms());
    });
    bool waits = false;  // the log has ended
    const std::int64_t begin_ms = mono_ms();
    loop.every(milliseconds(100), [&] {
      if (const int asked = shared_->asked; asked > 0 && mono_ms() - begin_ms >= least_heard_ms) {
        if (!std::exchange(waits, true)) listening.begin_to_wait();
        shared_->awaited = listening.awaited();
        shared_->counted = asked;
      }
      // does not block: where the supervisor does not read them, lines are dropped
      send(lines, listening.news());
    });
    loop.run();
    if (reader) {
      const Outcome outcome = listening.outcome(*reader);
      send(out, std::string(outcome.answered ? "1" : "0") + (outcome.unusable ? "1" : "0") + outcome.text);
    }
  } catch (const std::exception& error) {
    send(lines, fmt::format("the process that listens to the bus failed: {}\n", error.what()));
    send(out, failed + std::string(error.what()));
  }
  _exit(0);
}

namespace {

/// A process that is forked has the signals that the supervisor blocks, and its open files: descriptors of
/// other children, whose ends are waited for.
void as_at_the_start(int out, int lines) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const auto [first, second] = std::minmax(out, lines);
  const auto close_from_to = [](int from, int to) {
    if (from <= to) close_range(static_cast<unsigned>(from), static_cast<unsigned>(to), 0);
  };
  close_from_to(3, first - 1);
  close_from_to(first + 1, second - 1);
  close_range(static_cast<unsigned>(second) + 1, ~0U, 0);
}

}  // namespace

BusWatch::BusWatch(const bus::Rig& rig, const std::string& url, const std::string& log,
                   const BusWatchOptions& options)
    : rig_(rig), url_(url), log_(log), options_(options) {
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw Error(std::string("mmap: ") + std::strerror(errno));
  shared_.reset(new (memory) Shared);
  start();
}

void BusWatch::start() {
  shared_->counted = 0;  // what another one counted says nothing of this one
  Pipe outcome = make_pipe(0), lines = make_pipe(O_NONBLOCK);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(0);
    setpgid(0, 0);  // a Ctrl-C is not for it
    as_at_the_start(outcome.write.get(), lines.write.get());
    listen(outcome.write.get(), lines.write.get());
  }
  if (pid_ < 0) throw Error(std::string("fork: ") + std::strerror(errno));
  outcome_ = std::move(outcome.read);
  lines_ = std::move(lines.read);
  started_ = std::chrono::steady_clock::now();
}

std::optional<int> BusWatch::listen_again() {
  if (pid_ < 0 || std::chrono::steady_clock::now() - started_ < options_.least_life) return std::nullopt;
  try {
    end();
    start();
    return lines();
  } catch (const Error&) {
    return std::nullopt;
  }
}

BusWatch::~BusWatch() {
  end();
}

void BusWatch::Unmap::operator()(Shared* shared) const {
  munmap(shared, sizeof(Shared));
}

std::optional<milliseconds> BusWatch::silence(pid_t pid) const {
  for (const Shared::Process& process : shared_->processes)
    if (process.pid == pid) return milliseconds(std::max<std::int64_t>(0, mono_ms() - process.heard_ms));
  return std::nullopt;
}

milliseconds BusWatch::announced_silence(pid_t pid) const {
  for (const Shared::Process& process : shared_->processes)
    if (process.pid == pid) return std::chrono::seconds(process.announced_s);
  return milliseconds(0);
}

int BusWatch::awaited() const {
  const int asked = ++shared_->asked, counted = shared_->counted;
  if (pid_ > 0 && asked - counted > most_not_counted) kill(pid_, SIGCONT);
  return counted > 0 ? static_cast<int>(shared_->awaited) : static_cast<int>(rig_.pairs.size());
}

void BusWatch::end() {
  if (pid_ < 0) return;
  const pid_t pid = std::exchange(pid_, -1);
  if (waitpid(pid, nullptr, WNOHANG) == 0) terminate(pid);
  // what it still writes must not block it
  char rest[4096];
  while (read(outcome_.get(), rest, sizeof rest) > 0) {
  }
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Outcome BusWatch::outcome() {
  if (pid_ < 0)  // a signal to -1 would be one to every process of the user
    throw Error(
        "the process that listened to the bus could not be started again: what was calibrated is not known");
  terminate(pid_);
  std::string text;
  char part[4096];
  for (ssize_t n = 1; n > 0 || (n < 0 && errno == EINTR);) {
    n = read(outcome_.get(), part, sizeof part);
    if (n > 0) text.append(part, static_cast<std::size_t>(n));
  }
  end();
  if (text.starts_with(failed))
    throw Error("the process that listened to the bus failed, what was calibrated is not known: " +
                text.substr(1));
  if (text.size() < 2)
    throw Error("the process that listened to the bus was killed: what was calibrated is not known");
  return {text[0] == '1', text[1] == '1', text.substr(2)};
}

}  // namespace egocal::tools
