// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::tools {

/// What goes wrong with the sensors of a simulated drive, as typed: NAME=VALUE each.
struct FaultTexts {
  std::vector<std::string> rates, phases, scales, scale_drifts, clock_offsets, clock_drifts, dropped,
      outliers, noise_factors, bumps, creeps, jumps;
};

void add_fault_options(cli::App command, FaultTexts& texts);

/// Per sensor, in the order of the names. duration: of the drive [s], within which things happen. Throws
/// UsageError for an unknown name, a value that is no number or out of range, or one that is given twice.
std::vector<SensorFaults> understood(const FaultTexts& texts, const std::vector<std::string>& names,
                                     double duration);

}  // namespace egocal::tools
