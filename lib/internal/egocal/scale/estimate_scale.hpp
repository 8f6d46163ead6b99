// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal {

struct DriveScaleOptions {
  ScaleOptions scale;  ///< its mode and balance are replaced by those of the pairing
  /// Motions for the first guess, before anything is known of outliers, span this time [s]: long enough to be
  /// more than noise, short enough to be many.
  double first_motion = 1;
  /// A motion that fits this many times worse than the median one is omitted; the rest is solved again. Five
  /// standard deviations.
  double most_residual = 25;
  int rounds = 4;  ///< a limit: the pairing of the scaled streams is repeated until the scale stays
};

/// The scale of one stream's translations from two trajectories: pairs them, omits motions that do not
/// fit, and repeats both with the scale found, since screw congruence holds at the true scale only. Multiply
/// the stream by it (scaled()) and calibrate. The time offset of `pairing` is used, not estimated.
/// Empty where no motion pair is found. Deterministic.
std::optional<ScaleSolution> estimate_scale(const Trajectory& a, const Trajectory& b,
                                            const PairingOptions& pairing = {},
                                            const DriveScaleOptions& options = {});

/// The same from motion pairs; in planar mode as seen from the planes, that of the scaled sensor through its
/// origin (the height of a plane is in metres already).
ScaleSolution estimate_scale(std::span<const MotionPair> pairs, const DriveScaleOptions& options = {});

}  // namespace egocal
