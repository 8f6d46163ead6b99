// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that were summed up from steps the wrong way round.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct ReversedStepsOptions {
  /// A first look at short motions (this part of those that are compared) and at those themselves: squares
  /// must be smaller by this factor there. To first order a motion of reversed steps is the inverse motion.
  int shorter = 8;
  double promising = 0.8;
  /// Where a vehicle drives on flat ground, steps reversed in b look like a b that is mounted back to front
  /// and upside down. With an answer within this of such a mounting [rad] both are named.
  double like_mounting = 0.5;
};

/// Findings that the steps of one stream are the wrong way round: registration gave the transform from each
/// row to the one before, where the transform from the one before to the row was meant.
/// - reversed_steps: the whole step is inverted. Steps inverted in a look like those inverted in b, with the
///   same extrinsic, so one finding names either. Uncertain where a mounting explains the motions as well.
/// - axes_a, axes_b: the rotation of each step alone is inverted.
std::vector<Finding> reversed_steps(const Evidence& evidence, const DiagnosisOptions& options,
                                    const ReversedStepsOptions& reversed = {});

}  // namespace egocal::detail
