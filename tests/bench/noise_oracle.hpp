// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "noisy_machines.hpp"

namespace egocal::bench {

/// Of x, y, z, roll, pitch and yaw in the frame of a [m, rad]; in the plane three of them are known.
struct OracleAnswer {
  std::array<bool, 6> known{};
  std::array<double, 6> error{}, stddev{};
};

/// Estimator that is told the form of the noise, but not its size: maximum likelihood around the truth.
/// Rotation and translation of the noise on motions and of that on poses each have an unknown size, and the
/// memory is unknown where there is one. Sizes by restricted maximum likelihood. Knows nothing of heavy
/// tails, and takes noise that is a part of each motion for one that is the same for all.
OracleAnswer oracle(const testing::Streams& streams, const DriveNoise& noise, bool plane);

}  // namespace egocal::bench
