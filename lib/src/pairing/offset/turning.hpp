// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// From a trajectory to the angles that the sensor turns by, without its glitches.
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/pairing/time_offset.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "pairing/offset/correlation.hpp"

namespace egocal::detail {

/// Median time between poses [us]; at least 1. Needs two poses.
std::int64_t median_period_us(const Trajectory& trajectory);

/// Without poses that are not valid, or less than `least_us` (positive) after the one before; with unit
/// poses.
Trajectory thinned(const Trajectory& trajectory, std::int64_t least_us);

/// The part with most poses among those that last no longer than most_sparse times what is known: a stray
/// stamp far away does not make a grid longer. Known is what lies between poses at most max_gap_us apart.
Trajectory dense_part(const Trajectory& trajectory, std::int64_t max_gap_us, std::int64_t most_sparse);

/// How much longer the way over a pose is than the way past it.
struct Detour {
  double angle = 0, length = 0;            ///< [rad], [m]
  double past_angle = 0, past_length = 0;  ///< of the way past
};
/// Of pose i of the trajectory; zero for the first and the last.
Detour detour(const Trajectory& trajectory, std::size_t i);

/// Without the single poses that lie far off the way of their neighbours: options.outlier times further than
/// is typical, and more than options.least_detour of what the sensor moved past them.
Trajectory without_glitches(const Trajectory& trajectory, const std::vector<Detour>& detours,
                            const TimeOffsetOptions& options);

/// Number of points of a grid over the trajectory.
std::size_t grid_size(const Trajectory& trajectory, std::int64_t step_us);

/// Angle turned by in the two steps after point k of the grid [rad]; negative where not known. `from`: where
/// to begin looking; moves on.
double turn_at(const Trajectory& trajectory, std::size_t k, std::int64_t step_us, std::int64_t max_gap_us,
               std::size_t& from);

/// Large angles limited: neither a jump nor one wild turn outweighs the rest of the drive.
void limit_largest(Series& angles);

}  // namespace egocal::detail
