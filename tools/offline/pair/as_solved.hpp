// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/calibrate.hpp"
#include "offline/pair/calibration.hpp"
#include "offline/pair/motions.hpp"

namespace egocal::tools {

/// The motions that the answer was made from: as their poses were read, with their scale.
Motions as_solved(Motions motions, const CalibrationOptions& options, const SolveResult& result);

/// How as_solved() motions were paired, and b on the clock of a.
struct Paired {
  PairingOptions options;
  Trajectory b;
};
Paired as_paired(const Motions& motions, const CalibrationOptions& options, const Calibration& calibration);

/// The motion pairs of the stride and the weights that were chosen, from the beginning of the drive. motions:
/// as_solved().
std::vector<MotionPair> pairs_of(const Motions& motions, const CalibrationOptions& options,
                                 const Calibration& calibration);

/// Motions as long as those that the fit is stated of, wrong ones included. motions: as_solved().
std::vector<MotionPair> pairs_of_fit(const Motions& motions, const CalibrationOptions& options,
                                     const Calibration& calibration);

}  // namespace egocal::tools
