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
Trajectory thinned(Trajectory trajectory, std::int64_t least_us);
/// The same in pieces and in place: of the poses [begin, end), those that stay follow the first `kept` ones,
/// which are what stays of the poses before. Returns how many stay up to here.
std::size_t thin(Trajectory& trajectory, std::size_t begin, std::size_t end, std::size_t kept,
                 std::int64_t least_us);

/// The part with most poses among those that last at most most_sparse times the known time, so that a stray
/// stamp far away does not lengthen the grid. The known time is that between poses at most max_gap_us apart.
Trajectory dense_part(Trajectory trajectory, std::int64_t max_gap_us, std::int64_t most_sparse);

/// How much longer the way over a pose is than the way past it.
struct Detour {
  double angle = 0, length = 0;            ///< [rad], [m]
  double past_angle = 0, past_length = 0;  ///< of the way past
};
/// Detour of pose i of the trajectory; zero for the first and the last one.
Detour detour(const Trajectory& trajectory, std::size_t i);

/// Whether pose i is single and far from the path of its neighbours: options.outlier times farther than is
/// typical, and more than options.least_detour of the motion past it. typical: of the detours of all poses,
/// three at least.
bool is_glitch(const std::vector<Detour>& detours, std::size_t i, const Detour& typical,
               const TimeOffsetOptions& options);
double median_of(const std::vector<Detour>& detours, double Detour::*member);

/// Number of points of a grid over the trajectory.
std::size_t grid_size(const Trajectory& trajectory, std::int64_t step_us);

/// Angle turned by in the two steps after point k of the grid [rad]; negative: not known. `from`: index to
/// search from; it is moved forwards.
double turn_at(const Trajectory& trajectory, std::size_t k, std::int64_t step_us, std::int64_t max_gap_us,
               std::size_t& from);

/// Limits large angles, so that neither a jump nor a wild turn outweighs the rest of the drive.
void limit_largest(Series& angles);

}  // namespace egocal::detail
