// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "egocal/bus/rig.hpp"
#include "egocal/io/descriptor.hpp"
#include "supervision/bus_news.hpp"
#include "supervision/outcome.hpp"

namespace egocal::tools {

/// A pairing process that is alive on the bus within this time, as text: "egocal-pairing (pid 7 on car)".
std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time);

struct BusWatchOptions {
  BusNewsOptions news;
  OutcomeOptions outcome;
  /// A listening process that ends sooner than this is not started again: it would end again.
  std::chrono::milliseconds least_life{1000};
};

/// Listens to the processes, answers and verdicts of a rig while this object exists: a process of its own, so
/// that the supervisor has no threads. Ends with us.
class BusWatch {
 public:
  /// Listens to the bus at this URL. log: the log that is played on it; empty: none is. The rig must exist as
  /// long as this object.
  BusWatch(const bus::Rig& rig, const std::string& url, const std::string& log,
           const BusWatchOptions& options = {});
  ~BusWatch();
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// How long ago the status of a process on this host was received; nothing: never.
  std::optional<std::chrono::milliseconds> silence(pid_t pid) const;
  /// For how long the process may be silent after that status because it computes, see
  /// bus::announced_silence().
  std::chrono::milliseconds announced_silence(pid_t pid) const;
  /// The number of pairs whose newest answer or verdict is not about their last motions: those of a drive's
  /// end still come. Asked at a log's end for the first time. The last motions are known once pairing has
  /// sent the same problem again after it has acknowledged its last message. All pairs, until the listening
  /// process has counted since the first question; a process that does not count is continued (SIGCONT).
  int awaited() const;
  /// The listening process; -1: none runs.
  pid_t pid() const { return pid_; }
  /// A file descriptor of lines of text, see BusNews, that is read without blocking.
  int lines() const { return lines_.get(); }
  /// Starts another listening process where the first one was killed, and returns the new lines(): problems
  /// and answers are sent again each second, so it soon knows what the first one knew. Empty where it cannot
  /// be started, or the first one ended at once.
  std::optional<int> listen_again();
  /// Stops listening and reads the log for what is missing in the answers. Once. Throws Error where the
  /// listening process failed or was killed.
  Outcome outcome();

 private:
  struct Shared;
  /// Runs the listening process until it gets SIGTERM. Then the outcome goes to `out`.
  [[noreturn]] void listen(int out, int lines);
  void start();
  void end();

  struct Unmap {
    void operator()(Shared* shared) const;
  };
  const bus::Rig& rig_;
  std::string url_, log_;
  BusWatchOptions options_;
  std::unique_ptr<Shared, Unmap> shared_;  ///< memory of both processes
  Descriptor outcome_, lines_;             ///< what the listening process writes
  pid_t pid_ = -1;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace egocal::tools
