// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

struct TimeOffsetOptions {
  double max_gap = 0.5;      ///< poses further apart are not interpolated between [s]
  double least_overlap = 5;  ///< offsets at which the streams share less than this are not considered [s]
};

/// What has to be added to the stamps of b so that both streams run on the clock of a.
struct TimeOffset {
  double seconds = 0;
  double stddev = 0;       ///< of the refinement, from the curvature of the cost [s]
  double correlation = 0;  ///< of the angular rates at the offset, [-1, 1]; below about 0.5 do not trust it
};

/// The angle that a rigid body turns by between two instants is the same for every sensor on it, whatever the
/// extrinsic: correlated over all offsets at which the streams overlap, it finds the offset of clocks that
/// share nothing. Then the certified minimum of the cost (18) as a function of the offset is minimised. Empty
/// where the streams are too short or never turn.
std::optional<TimeOffset> estimate_time_offset(const Trajectory& a, const Trajectory& b,
                                               const TimeOffsetOptions& options = {});

}  // namespace egocal
