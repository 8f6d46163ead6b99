// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Steps of one stream that all turn a factor too far, about whatever axis: half angles where a gyroscope is
// summed up, its unit or its scale.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct TurningOfStepsOptions {
  /// Parts by which both sensors turn unlike, at least: TurningScaleOptions.
  double least = 0.005;
  /// Motions this many times as long must show at least this part of the factor's logarithm. What
  /// noise adds to the turning of one stream is a third of it there (mathematics: of a random walk; less of
  /// white noise), and chords of turns to and fro lose a part of any factor.
  int longer = 3;
  double part_of_longer = 0.5;
  /// Mean log ratio of the squared residuals, at least: as that of rotation vectors of another length
  /// (TurningScaleOptions::gain_of_vectors).
  double gain = 2;
};

/// Better by noise alone where the motions are short, and not where they are longer. ratio: of the turns of b
/// to those of a, in the motions given; in a drive of fewer than three of them they are the longer ones,
/// beside shorter ones.
bool turns_too_far_by_more_than_noise(const Instants& instants, const Motions& motions, double ratio,
                                      const DiagnosisOptions& options,
                                      const TurningOfStepsOptions& turning = {});

/// The stream, or both where either may be the one, whose steps turn a factor too far: findings
/// turning_scale_a|_b. Its positions are right, or were summed up with these rotations. instants, given: the
/// drive, and its motions with the extrinsic that suits them as they are.
std::vector<Finding> turning_of_steps(const Instants& instants, const Explained& given,
                                      const DiagnosisOptions& options,
                                      const TurningOfStepsOptions& turning = {});

}  // namespace egocal::detail
