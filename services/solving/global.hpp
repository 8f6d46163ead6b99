// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solving/scales.hpp"
#include "solving/solver.hpp"

namespace egocal::services {

/// egocal-global: answers while the fast process asks for it (calibration_t.fallback), while none is alive,
/// or always.
class GlobalSolver final : public Solver {
 public:
  GlobalSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method, bool always);

 private:
  struct Task {
    std::optional<ReceivedProblem> unanswered;
    bool asked = false;  ///< by the newest answer of a fast process
  };

  void answer_newest() override;
  void repeat_scales() override { scales_.repeat(); }
  void hear(std::size_t pair, const calibration_t& message) override;
  /// Nothing is remembered from problem to problem.
  void reset(std::size_t) override {}
  bus::State state() const override { return steps_in() ? bus::State::running : bus::State::standby; }
  std::string advice() const override;
  bool steps_in() const { return always_ || !heartbeat_.alive(bus::Role::fast); }

  Method method_;
  bool always_;
  ScaleDesk scales_;         ///< answered always: no fast process does while this one is alive
  std::vector<Task> tasks_;  ///< of the pairs
};

}  // namespace egocal::services
