// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One half of a stream comes at a lower rate and is held in between: positions of a slow receiver in the rows
// of fast rotations, tables that were joined by the last value. A value that is held for three rows is a row
// late in the mean, and with it the lever arm is wrong by the way of that time, at any residual.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/streams/held.hpp"

namespace egocal::detail {

/// Study: tests/lib/test_held_streams.cpp.
struct HeldStreamOptions {
  HeldOptions rows;
  std::size_t most = 700;  ///< held values that are looked at, evenly spread; as motions elsewhere
  /// Least ratio of two medians: the motion of the sensor while a value repeats, to the residual of motions
  /// between new values. With rounding alone the two are alike, and an arm that turns in one place hardly
  /// moves; a held value is wrong by a whole step.
  double moved = 3;
};

/// Findings held_a, held_b, certain: the positions, or the rotations, of a stream repeat (sample and hold)
/// although the other stream shows that the sensor moves. The finding has the answer of the new poses alone.
/// max_gap: of interpolation [s]. beside: the other findings; of these a certain clock and scale are applied.
std::vector<Finding> held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                                  const std::vector<Finding>& beside, const HeldStreamOptions& options = {});

/// Adds these findings before the others, and removes those that describe the same fault less precisely: held
/// values are also late.
void name_held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                       std::vector<Finding>& findings);

}  // namespace egocal::detail
