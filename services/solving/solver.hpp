// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "egocal/bus/rig.hpp"
#include "program/commands.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

/// The common part of the solver processes: the newest problem of each pair, the answers of other solvers,
/// commands, counters and the status. A solver has no state worth keeping, as the next problem is enough.
class Solver {
 public:
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

 protected:
  struct Pair {
    Pair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& config)
        : inbox(loop, heartbeat, config), outbox(loop, heartbeat) {}
    ProblemInbox inbox;
    AnswerOutbox outbox;
    std::int64_t session = -1;       ///< of the newest problem
    problem_t newest{};              ///< whose answer may be sent again; without its blocks
    std::int64_t heard_mono_us = 0;  ///< when it was received last
    bool paused = false;
  };

  Solver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig);

  /// A problem that came since the last call; its session is the pair's from now on.
  std::optional<ReceivedProblem> take(std::size_t pair);
  /// Puts the state of this process into its status, once a second and on commands.
  void report();

  /// Called when problems may be waiting, and once a second, because another process may have fallen silent.
  virtual void answer_newest() = 0;
  /// Called once a second: sends the scales again while pairing is silent.
  virtual void repeat_scales() = 0;
  /// Takes an answer of another process to a problem of this pair.
  virtual void hear(std::size_t pair, const calibration_t& message) = 0;
  virtual void reset(std::size_t pair) = 0;
  /// The state of this process while nothing is paused.
  virtual bus::State state() const = 0;
  /// Advice to the user about the other solvers, one line; empty: none.
  virtual std::string advice() const = 0;

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  std::vector<std::unique_ptr<Pair>> pairs_;

 private:
  void obey(Verb verb, const command_t& command);
  void repeat_answers();
};

}  // namespace egocal::services
