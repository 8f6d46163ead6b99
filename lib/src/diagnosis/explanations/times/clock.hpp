// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

/// The grid of turning rates that shows a clock coarsely. Study: tests/bench/mistake_study.cpp.
struct ClockGridOptions {
  double finest = 0.1;           ///< distance of its points, at least [s]: two poses of a slow sensor
  std::size_t least_cells = 20;  ///< points that both streams have in common: fewer correlate by chance
};

/// What the streams are, apart from their clocks.
struct Streams {
  const Trajectory& a;
  const Trajectory& b;
  PoseReading read_a, read_b;
  double max_gap = 0.5;      ///< [s]
  double motion_length = 1;  ///< of the motions that are compared [s]
  DiagnosisOptions options;
  /// Angles from each pose to the next, see turning_of() [rad].
  std::span<const float> turning_a, turning_b;
  std::size_t each = 1;  ///< every such pose of the slower stream is looked at
  ClockGridOptions grid{};
};

/// The angle from each pose to the next [rad].
std::vector<float> turning_of(const Trajectory& trajectory);

/// The motions under a clock, of about the given length, and their best extrinsic.
Explained explained_by(const Streams& streams, const ClockModel& clock);

struct ClockFit {
  ClockModel clock;
  Explained explained;
};

/// The clocks that fit best; empty where the streams never turn.
struct ClockFits {
  std::optional<ClockFit> offset;
  std::optional<ClockFit> drift;  ///< offset and rate
};

/// Offset, and offset with rate, of b's clock that fit best near `start`: the turning of the two bodies
/// finds them coarsely, the fit finely.
///
/// This is not estimate_time_offset(), with which it shares correlation and line fit. That one measures a
/// clock, by the certified cost (18) of motions that are right. This one is an explanation among others:
/// under a wrong reading no extrinsic fits and every motion looks like an outlier, so it minimises the same
/// robust misfit that explanations are compared by, on a coarse grid, as it is tried for several readings.
ClockFits fit_clock(const Streams& streams, const ClockModel& start);
/// The offset of b's clock alone, in a third of the time.
std::optional<ClockFit> fit_offset(const Streams& streams, const ClockModel& start);

}  // namespace egocal::detail
