// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/scale/solve_scale.hpp"
#include "egocal/scale_problem_t.hpp"
#include "egocal/scale_t.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

/// Answers the scale problems of pairs that have a sensor with scale = "auto". Each problem is solved once;
/// if it is sent again, the same answer is sent again.
class ScaleDesk {
 public:
  ScaleDesk(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig);

  /// To be called when problems may be waiting. publishes: false if another solver publishes the answers.
  void answer_newest(bool publishes = true);
  /// Sends the newest scales again while pairing is silent, whose problems would ask for them.
  void repeat(bool publishes = true);
  /// Adds what the uncertainty of the scale adds to the standard deviations of an answer, once a scale of
  /// this session was solved here.
  Answer with_spread(Answer answer, const ReceivedProblem& received) const;

 private:
  struct Pair {
    Pair(bus::Loop& loop, const bus::PairConfig& pair);
    bus::PairConfig config;
    bus::Newest<scale_problem_t> inbox;
    std::optional<scale_t> last;
    ScaleSolution solution;  ///< of the last one
    std::int64_t heard_mono_us = 0;
  };
  void answer(Pair& pair, const scale_problem_t& problem, bool publishes);

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  std::vector<std::unique_ptr<Pair>> pairs_;
};

}  // namespace egocal::services
