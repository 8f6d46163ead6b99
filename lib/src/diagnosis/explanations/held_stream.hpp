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
  /// Least ratio of two medians: what the sensor moves while a value repeats, and what the motions between
  /// new values leave unexplained. Rounding makes them alike. An arm that turns in one place hardly moves. A
  /// held value is wrong by a whole step.
  double moved = 3;
};

/// held_a, held_b, certain: the positions, or the rotations, of a stream repeat although the sensor moves on,
/// as the other stream says. With the answer of the poses that are new. max_gap: of interpolation [s].
/// beside: what else was found; the other stream says so on the clock and at the scale that are certain.
std::vector<Finding> held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                                  const std::vector<Finding>& beside, const HeldStreamOptions& options = {});

/// Puts them before the others, without those that are the same with less certainty: held values are late.
void name_held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                       std::vector<Finding>& findings);

}  // namespace egocal::detail
