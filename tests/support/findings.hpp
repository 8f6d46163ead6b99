// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives whose verdict is looked at, and the findings of one.
#pragma once

#include <cstdint>
#include <string>

#include "egocal/calibrate.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// A minute with 1 % noise.
inline Streams drive(Terrain terrain, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 601;
  options.relative_noise = 0.01;
  options.seed = seed;
  return simulated_drive(options);
}

/// The finding of a code, or null.
inline const Finding* find(const Calibration& calibration, const std::string& code) {
  for (const Finding& finding : calibration.findings)
    if (finding.code == code) return &finding;
  return nullptr;
}

}  // namespace egocal::testing
