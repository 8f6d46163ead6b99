// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "egocal/bus/rig.hpp"

namespace egocal::tools {

/// A pairing process that is alive on the bus within this time, as text: "egocal-pairing (pid 7 on car)".
std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time);

/// What was calibrated while somebody watched.
struct Outcome {
  bool answered = false;  ///< any solver, for any pair
  bool unusable = false;  ///< some pair's motions contradict each other, or miss the goal
  std::string text;       ///< of each pair verdict, proof and transform, or that there is no answer
};

/// Listens to the answers and verdicts of a rig while this object exists: a process of its own, so that the
/// supervisor has no threads. Ends with us.
class AnswerListener {
 public:
  AnswerListener(const bus::Rig& rig, const std::string& url);
  ~AnswerListener();
  AnswerListener(const AnswerListener&) = delete;
  AnswerListener& operator=(const AnswerListener&) = delete;

  /// Answers whose newest verdict is not about the newest motions: those of a drive's end still come.
  int not_judged() const { return *not_judged_; }
  /// Stops listening. Once.
  Outcome outcome();

 private:
  void end();

  pid_t pid_ = -1;
  int pipe_ = -1;
  std::atomic<int>* not_judged_ = nullptr;  ///< in memory that both processes share
};

}  // namespace egocal::tools
