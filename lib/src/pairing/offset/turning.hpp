// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Angles that a sensor turns by, from its trajectory without glitches.
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/pairing/time_offset.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "pairing/offset/correlation.hpp"

namespace egocal::detail {

/// Median time between poses [us]; at least 1. Needs two poses.
std::int64_t median_period_us(const Trajectory& trajectory);

/// The trajectory with unit poses, without invalid poses and without those less than `least_us` (positive)
/// after the one before.
Trajectory thinned(const Trajectory& trajectory, std::int64_t least_us);

/// The part with most poses among those that last at most most_sparse times the known time, so that a stray
/// stamp far away does not lengthen the grid. The known time is that between poses at most max_gap_us apart.
Trajectory dense_part(const Trajectory& trajectory, std::int64_t max_gap_us, std::int64_t most_sparse);

/// How much longer the way over a pose is than the way past it.
struct Detour {
  double angle = 0, length = 0;            ///< [rad], [m]
  double past_angle = 0, past_length = 0;  ///< of the way past
};
/// Detour of pose i of the trajectory; zero for the first and the last one.
Detour detour(const Trajectory& trajectory, std::size_t i);

/// The trajectory without single poses far from the path of their neighbours: options.outlier times farther
/// than is typical, and more than options.least_detour of the motion past them.
Trajectory without_glitches(const Trajectory& trajectory, const std::vector<Detour>& detours,
                            const TimeOffsetOptions& options);

/// Number of points of a grid over the trajectory.
std::size_t grid_size(const Trajectory& trajectory, std::int64_t step_us);

/// Angle turned by in the two steps after point k of the grid [rad]; negative: not known. `from`: index to
/// search from; it is moved forwards.
double turn_at(const Trajectory& trajectory, std::size_t k, std::int64_t step_us, std::int64_t max_gap_us,
               std::size_t& from);

/// Limits large angles, so that neither a jump nor a wild turn outweighs the rest of the drive.
void limit_largest(Series& angles);

}  // namespace egocal::detail
