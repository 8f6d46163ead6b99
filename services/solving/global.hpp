// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "program/commands.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

/// egocal-global: answers while the fast process asks for it (calibration_t.fallback), while none is heard,
/// or always.
class GlobalSolver {
 public:
  GlobalSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method, bool always);

 private:
  struct Pair {
    Pair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& config)
        : inbox(loop, heartbeat, config), outbox(loop, heartbeat) {}
    ProblemInbox inbox;
    AnswerOutbox outbox;
    std::optional<ReceivedProblem> unanswered;
    std::int64_t session = -1;  // of the newest problem
    bool paused = false;
    bool asked = false;  // by the newest answer of a fast process
  };

  void answer_newest();
  void hear(Pair& pair, const calibration_t& message);
  void obey(Verb verb, const command_t& command);
  void report();

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  Method method_;
  bool always_;
  std::vector<std::unique_ptr<Pair>> pairs_;
};

}  // namespace egocal::services
