// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/online/algorithm1.hpp"
#include "solving/scales.hpp"
#include "solving/solver.hpp"

namespace egocal::services {

/// egocal-fast: the fast solution from the last answer, verified at every step (Algorithm 1). While it has
/// not been verified for t_no_fail its answers ask for the global process; while that one is silent the
/// global solver runs here.
class FastSolver final : public Solver {
 public:
  FastSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method);

 private:
  struct Progress {
    OnlineState state;
    std::int64_t session = -1;  ///< of the newest answer
    std::int64_t utime = 0;
  };

  void answer_newest() override;
  void repeat_scales() override { scales_.repeat(!heartbeat_.alive(bus::Role::global)); }
  void hear(std::size_t pair, const calibration_t& message) override;
  void reset(std::size_t pair) override { progress_[pair].state = {}; }
  bus::State state() const override { return bus::State::running; }
  std::string advice() const override;
  void answer(std::size_t pair, const ReceivedProblem& received);

  OnlineOptions options_;
  ScaleDesk scales_;  ///< used only while no global process is alive, as a scale has no local solution
  std::vector<Progress> progress_;  ///< of the pairs
};

}  // namespace egocal::services
