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

/// Answers the scale problems of those pairs of which a sensor has scale = "auto": each once, and with the
/// same message again when the problem is sent again.
class ScaleDesk {
 public:
  ScaleDesk(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig);

  /// Problems may be waiting. publishes: false where another solver answers them.
  void answer_newest(bool publishes = true);
  /// Sends the newest scales again where pairing is silent, which would ask for them.
  void repeat(bool publishes = true);
  /// An answer at an unknown scale is as uncertain as that is: adds the scale's part to its standard
  /// deviations, once a scale of the problem's session was solved here.
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
