// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Headings of one stream that wander against its positions: those of a gyroscope whose bias wanders, beside
// the positions of another sensor. In each part of the drive the motions agree, with an answer that is turned
// by the heading's error there, and the parts scatter by less than the error that they have in common.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Headings that wander".
struct WanderingHeadingsOptions {
  std::size_t least = 60;     ///< motions; fewer do not show the headings of parts
  std::size_t parts = 24;     ///< of the drive, each with a heading of its own
  double least_weight = 0.1;  ///< of a part, beside the median one: others stand
  std::size_t least_parts = 12;
  double outlier = 100;  ///< squares beyond this many times the median one lose weight (MountFitOptions)
  int rounds = 5;        ///< of weights
  /// Mean squared difference of the headings of neighbouring parts over their variance: 2 where they are
  /// independent, 0 where they change slowly. Clean drives have at least 1, with noise that is remembered for
  /// a second, wandering headings of vehicles 0.02 to 0.6.
  double most_uneven = 0.6;
  double matters = 2;           ///< standard deviations of the answer by which it moves, at least
  double least_move = 1.0 / 6;  ///< of the tolerances (LengthsInTurnsOptions::least_move)
};

/// Heading of the rotations against the positions, in the parts of a drive.
struct WanderingHeadings {
  double unevenness = 2;              ///< of neighbouring parts (WanderingHeadingsOptions::most_uneven)
  double most = 0;                    ///< farthest of a part from that of the drive [rad], either sign
  Vector6d moved = Vector6d::Zero();  ///< by which the answer is another one at that heading, frame a
};

/// By the motions as given: what the translations of each part turn about the axis that the sensors mostly
/// turn about, beside the answer of all. Empty: too few motions, or too few parts that move.
std::optional<WanderingHeadings> wandering_headings(const Explained& given,
                                                    const WanderingHeadingsOptions& options = {});

/// Adds to answered.timing_stddev and result.timing_stddev what headings that wander move the answer by, and
/// names turning_drift_a and _b, uncertain, where nothing else is named for it. Nothing where something else
/// explains the streams.
void name_wandering_headings(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                             Diagnosis& result, const WanderingHeadingsOptions& wandering = {});

}  // namespace egocal::detail
