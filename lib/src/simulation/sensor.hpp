// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/random.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::detail {

/// Poses of the vehicle; between them it moves along a path without corners.
struct Path {
  std::vector<std::int64_t> stamps;  ///< [us] from the start of the drive
  std::vector<double> times;         ///< the same [s]
  std::vector<Pose> poses;
};

/// What the odometry of one sensor says of the path. random: the drive's, for the noise; faults have random
/// numbers of their own.
Trajectory drive_sensor(const SimulationOptions& options, const Path& path, std::size_t sensor,
                        Random& random);

}  // namespace egocal::detail
