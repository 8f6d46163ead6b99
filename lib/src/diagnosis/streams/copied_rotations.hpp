// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one sensor in both streams.
#pragma once

#include <numbers>
#include <optional>

#include "diagnosis/explanations/times/clock.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct CopiedRotationsOptions {
  std::size_t looked_at = 200;  ///< rows of a stream, evenly spread, at most
  std::size_t fewest = 20;      ///< of their differences
  /// Half of the angles agree to less [rad]: rounding, and a hundredth of what two sensors leave.
  double of_rounding = 1e-5;
  double turning = 0.01;  ///< the median angle, at least [rad]: a thousand times the above
  /// Residuals of rotations that are rounding of doubles [rad].
  double exact = 1e-9;
  /// Where an explanation makes the squared residuals smaller by more than this, the positions have no noise
  /// either: a simulation. Rotations that were made from the other stream's, beside positions with noise of
  /// 0.1 to 1 %: 10 to 8e5 in 20 drives.
  double without_noise = 1e8;
};

/// same_stream, uncertain: between the rows of one stream the other one, interpolated linearly, turns by the
/// same angles to rounding. Whatever the extrinsic, two sensors never do. clock: of b. max_gap: [s].
std::optional<Finding> copied_rotations(const Trajectory& a, const Trajectory& b, const ClockModel& clock,
                                        double max_gap, const CopiedRotationsOptions& options = {});

/// same_stream, uncertain, where the motions turn by `turning` and the rows do not: half of the rotations of
/// the motions agree to rounding of doubles, as those of an odometry and of a map that corrects it now and
/// then.
std::optional<Finding> exactly_copied_rotations(const Fit& fit, const Motions& motions,
                                                const CopiedRotationsOptions& options = {});

}  // namespace egocal::detail
