// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that were summed up from steps of the body with the attitude of another instant: of the end of
// each row instead of its begin, or of an end instead of the middle.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Study: 18 simulated drives (cars, a truck, a tractor, a drone; rows of 2 to 100 Hz) with the mistake, 50
/// of eleven kinds of vehicles without it, none of which is named, and twelve pairs of real sensors.
struct TurnedStepsOptions {
  /// Largest difference, as a part of a row, between the part that suits the motions best and the part that a
  /// mistake makes: 0.15 in the mistakes that were found.
  double near = 0.2;
  /// Least distance of the part from zero, in its standard deviations (jack-knife). From `certain` on the
  /// finding is certain. Real pairs reach 1.7: the long way of cars drifts as if they were turned by 0.4 of a
  /// row.
  double sigmas = 3, certain = 5;
  double most_sigmas = 3;  ///< that it may be from what the mistake makes
  unsigned blocks = 16;    ///< parts of the drive that the jack-knife omits in turn, at most
  unsigned fewest = 4;     ///< fewer say nothing of a standard deviation
  /// Mean logarithm by which the squared residuals of the translations [m^2] are smaller then, at least.
  /// Real pairs reach 0.03, mistakes that move the answer by decimetres 0.15 to 5.
  double least_gain = 0.1;
  /// Least change of the lever arm, as a part of the tolerance of an answer: 10 cm, as ten milliseconds of a
  /// car make (LatePositionsOptions::least).
  double least_change = 1.0 / 6;
};

/// How well one part of a row suits the motions.
struct TurnedSteps {
  Side side = Side::b;
  double part = 0;  ///< of a row by which its steps were turned on; > 0: attitudes that are late
  double fitted = 0, stddev = 0;  ///< the part that suits the motions best
  double gain = 0;                ///< mean logarithm of squared residuals of the translations, > 0 for it
  Explained explained;            ///< with the steps turned back
};

/// Turned steps that the drive shows, the part that fits best first; empty for nearly every drive. Positions
/// that are late or early by a constant time fit worse than each.
std::vector<TurnedSteps> turned_steps(const Evidence& evidence, const DiagnosisOptions& options,
                                      const TurnedStepsOptions& turned = {});

/// Findings axes_a, axes_b with the extrinsic that the steps have when turned back.
std::vector<Finding> worded_steps(const std::vector<TurnedSteps>& found, const Evidence& evidence,
                                  const DiagnosisOptions& options, const TurnedStepsOptions& turned = {});

}  // namespace egocal::detail
