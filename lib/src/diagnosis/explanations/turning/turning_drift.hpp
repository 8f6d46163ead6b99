// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one stream that turn away from its positions at a constant rate: those of a gyroscope with a
// bias, beside the positions of another sensor.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes".
struct TurningDriftOptions {
  /// By how many of its standard deviations the rate differs from zero, at least. They are those of `parts`
  /// parts of the drive.
  double sigmas = 6;
  std::size_t parts = 16;
  /// What the stream turns too far in the drive, at least, as a part of the tolerance: less moves no answer.
  double least = 1;
  double most_rate = 0.1;  ///< 6 deg/s, more than gyroscopes for models have [rad/s]
  int rounds = 3;          ///< in which rate and extrinsic are fitted in turn
  double inlier = 9;       ///< squared residuals count up to this many times the median one
};

/// The stream whose rotations drift, the extrinsic without that, and by how much the motions then fit better,
/// where they clearly do. Both streams, the better one first, where either may be the one. An odometry that
/// sums its positions up with such rotations is not named: it hardly moves the answer, and nothing tells
/// which of two it is. instants, given: the drive, and its motions with the extrinsic that suits them as they
/// are.
std::vector<Finding> turning_drift(const Instants& instants, const Explained& given,
                                   const DiagnosisOptions& options, const TurningDriftOptions& drift = {});

}  // namespace egocal::detail
