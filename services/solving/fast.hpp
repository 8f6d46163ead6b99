// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "egocal/online/algorithm1.hpp"
#include "program/commands.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

/// egocal-fast: the fast solution from the last answer, verified at every step (Algorithm 1). While it has
/// not been verified for t_no_fail its answers ask for the global process; while that one is silent the
/// global solver runs here.
class FastSolver {
 public:
  FastSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method);

 private:
  struct Pair {
    Pair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& config)
        : inbox(loop, heartbeat, config), outbox(loop, heartbeat) {}
    ProblemInbox inbox;
    AnswerOutbox outbox;
    OnlineState state;
    std::int64_t session = -1;
    std::int64_t utime = 0;
    std::int64_t seq = -1;
    bool paused = false;
  };

  void answer_newest();
  void answer(Pair& pair, const ReceivedProblem& received);
  void hear(Pair& pair, const calibration_t& message);
  void obey(Verb verb, const command_t& command);
  void report();

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  OnlineOptions options_;
  std::vector<std::unique_ptr<Pair>> pairs_;
};

}  // namespace egocal::services
