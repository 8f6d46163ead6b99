// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that belong to other times than the rotations of the same stream: a filter that smooths or delays
// one of them.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes".
struct LatePositionsOptions {
  /// Speeds are those over at least this time [s]: over less they are the noise of single poses.
  double least_span = 0.1;
  /// Instants that a speed spans on either side, at most: a stream of 1 kHz has a hundred in that time.
  std::size_t most_instants = 200;
  /// Times below this are not named [s]: a vehicle of 10 m/s goes 10 cm in it, and filters of inertial
  /// systems are not late by more.
  double least = 0.01;
};

/// The stream whose positions are late, or early, the extrinsic without that, and by how much the motions
/// then fit better, where they clearly do. Along a straight way at one speed, and in steady turns, this
/// cannot be seen: it looks like a longer lever arm. instants, given: the drive, and its motions with the
/// extrinsic that suits them as they are. only: of this stream; empty: of either.
std::optional<Finding> late_positions(const Instants& instants, const Explained& given,
                                      const DiagnosisOptions& options, std::optional<Side> only = {},
                                      const LatePositionsOptions& late = {});

}  // namespace egocal::detail
