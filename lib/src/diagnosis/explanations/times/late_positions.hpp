// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that belong to other times than the rotations of the same stream: a filter that smooths or delays
// one of them.
#pragma once

#include <optional>
#include <vector>

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

/// Positions of one stream that are taken later.
struct LatePositions {
  Side side = Side::b;
  double delay = 0;  ///< > 0: they belong to later times than the rotations [s]
  Explained explained;
  Comparison comparison;  ///< with the motions as they are
};

/// The stream whose late positions fit the motions better, and the other stream if it fits about as well.
/// Late positions of one stream look like early positions of the other one, except for the turn of the lever
/// arm in that time.
struct LateOfEither {
  LatePositions best;
  std::optional<LatePositions> other;
  bool other_first = false;  ///< it is the likelier one
};

/// instants: the drive. given: its motions as they are, with their extrinsic. behind: the stream to prefer if
/// either may be the one; empty: the one whose positions are late, because filters delay. Returns nothing if
/// there are too few motions.
std::optional<LateOfEither> best_late_positions(const Instants& instants, const Explained& given,
                                                const DiagnosisOptions& options,
                                                std::optional<Side> behind = {},
                                                const LatePositionsOptions& late = {});

/// Whether the delay explains the drive, and better than by chance. On a straight path at constant speed and
/// in steady turns a delay is not observable: it looks like a longer lever arm.
bool certain(const LateOfEither& found, const DiagnosisOptions& options,
             const LatePositionsOptions& late = {});

/// late_positions_a or late_positions_b, certain, with the extrinsic at that delay. Both, and uncertain,
/// where either may be the one. clock: of what the delay is seen, as "At this clock"; may be empty.
std::vector<Finding> worded(const LateOfEither& found, const char* clock = "");

}  // namespace egocal::detail
