// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "simulation/checks.hpp"
#include "simulation/plan.hpp"

namespace egocal::simulation {

struct Outcome {
  std::optional<Violation> violation;
  std::uint64_t trace = 0;        ///< of everything that was sent, arrived and ended, in order
  std::int64_t simulated_us = 0;  ///< virtual time
  std::int64_t messages = 0;      ///< sent
  int compared = 0;               ///< with an undisturbed run
  std::int64_t certificates = 0;  ///< compared with arithmetic of 113 bits
  std::int64_t judged_good = 0;   ///< verdicts compared with the truth
  std::int64_t scales = 0;        ///< compared with that of the drive
  std::size_t most_memory = 0;    ///< of any process at any time [bytes]
};

struct WorldOptions {
  /// Called with every line of the log of a life: incidents, deaths, starts; with `everything` also each
  /// message.
  std::function<void(const std::string& line)> tell = nullptr;
  bool everything = false;
};

/// Simulates one life: all processes, network, clocks and disks in this thread, in virtual time. The same
/// plan gives the same outcome on any machine.
Outcome live(const Plan& plan, const WorldOptions& options = {});

}  // namespace egocal::simulation
