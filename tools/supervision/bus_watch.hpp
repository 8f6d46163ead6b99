// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>

#include "egocal/bus/rig.hpp"
#include "supervision/bus_news.hpp"
#include "supervision/outcome.hpp"

namespace egocal::tools {

/// A pairing process that is alive on the bus within this time, as text: "egocal-pairing (pid 7 on car)".
std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time);

struct BusWatchOptions {
  BusNewsOptions news;
  OutcomeOptions outcome;
};

/// Listens to the processes, answers and verdicts of a rig while this object exists: a process of its own, so
/// that the supervisor has no threads. Ends with us.
class BusWatch {
 public:
  /// Of a bus on which this log is played; empty: none is.
  BusWatch(const bus::Rig& rig, const std::string& url, const std::string& log,
           const BusWatchOptions& options = {});
  ~BusWatch();
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// How long ago the status of a process on this host was received; nothing: never.
  std::optional<std::chrono::milliseconds> silence(pid_t pid) const;
  /// Pairs whose newest answer or verdict is not about the newest motions: those of a drive's end still come.
  int awaited() const;
  /// Readable, without blocking: lines of text, see BusNews.
  int lines() const { return lines_; }
  /// Stops listening and reads the log for what is missing in the answers. Once. Throws Error where the
  /// listening process was killed.
  Outcome outcome();

 private:
  struct Shared;
  /// The listening process, until it gets SIGTERM. Then the outcome goes to `out`.
  [[noreturn]] static void listen(const bus::Rig& rig, const std::string& url, const std::string& log,
                                  const BusWatchOptions& options, Shared& shared, int out, int lines);
  void end();

  pid_t pid_ = -1;
  int pipe_ = -1, lines_ = -1;
  Shared* shared_ = nullptr;  ///< memory of both processes
};

}  // namespace egocal::tools
