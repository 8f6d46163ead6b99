// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that are one row too late or too early beside the rotations of the same stream: columns of two
// tables that were joined one off, or a loop that writes the position before and the rotation after a step.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// The same numbers as TurnedStepsOptions, for the same reasons: both ask whether a number that is known
/// beforehand suits the motions.
struct LateByARowOptions {
  double near = 0.2;        ///< of a row, that the number of rows may differ from one, at most
  double sigmas = 5;        ///< least distance of that number from zero, in its standard deviations
  double most_sigmas = 3;   ///< that it may be from one
  unsigned blocks = 16;     ///< parts of the drive that the jack-knife omits in turn, at most
  unsigned fewest = 4;      ///< fewer say nothing of a standard deviation
  double least_gain = 0.1;  ///< mean logarithm by which the squares of the translations [m^2] are smaller
  double least_change = 1.0 / 6;  ///< of the lever arm, as a part of the tolerance of an answer: 10 cm
};

/// Positions of one stream that belong to the row before or after.
struct LateByARow {
  Side side = Side::b;
  double rows = 1;        ///< > 0: they are late; 1 or -1, but for the other stream what suits it best
  double seconds = 0;     ///< usual duration of a row
  double gain = 0;        ///< mean logarithm of squared residuals of the translations, > 0 for it
  Explained explained{};  ///< with the positions of the right rows
};

/// What the drive shows; empty: nothing. The best of the streams, and the other one where it fits about as
/// well (DiagnosisOptions::alike), the late one first.
std::vector<LateByARow> late_by_a_row(const Evidence& evidence, const DiagnosisOptions& options,
                                      const LateByARowOptions& late = {});

/// Findings late_positions_a|_b: both, each uncertain, where either stream may be the one.
std::vector<Finding> worded_rows(const std::vector<LateByARow>& found, const Evidence& evidence);

}  // namespace egocal::detail
