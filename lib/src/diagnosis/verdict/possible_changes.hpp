// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mounts that seem to have moved, and scales that seem to change, where noise that wanders for as long may
// look the same.
#pragma once

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct PossibleChangeOptions {
  /// The answer of a possible change is at most this far from the one that is judged, in tolerances: as far
  /// as noise of 10 % that wanders moves it. Study: docs/trust_rules.md, "Noise that is remembered".
  double farthest = 6;
};

/// A mount that moved, or a scale that changes, uncertain and with an answer of its own.
bool possible_change(const Finding& finding);

/// Adds how far the answers of possible changes are from this one to answered.timing_stddev and
/// result.timing_stddev, in the directions that are known: the motions do not tell which one is right.
void add_possible_changes(Answered& answered, Diagnosis& result);

}  // namespace egocal::detail
