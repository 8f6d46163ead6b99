// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions of one sensor in both streams, as of two attitude sensors beside one GNSS receiver.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

struct CopiedPositionsOptions {
  std::size_t looked_at = 1000;  ///< motions, evenly spread, at most
  std::size_t fewest = 20;       ///< of them that turn, at times that both streams have
  /// Motions that turn by less [rad] are not looked at: along a straight line two places of a vehicle travel
  /// the same distance, to all digits of a file. Here a metre between them makes a difference of 5 cm.
  double turning = 0.05;
  double part = 0.9;  ///< of the motions that turn, whose distances agree
  /// Distances agree to this part of the typical one: digits of files. Two odometries agree to 1e-3 at best.
  double of_distance = 1e-5;
};

/// same_stream, uncertain: in motions that turn both streams travel the same distances to rounding. Whatever
/// the extrinsic and the axes of the world, two sensors never do. Empty where too few motions turn, or begin
/// and end at times of both streams. motions: of the same instants.
std::optional<Finding> copied_positions(const Instants& instants, const Motions& motions,
                                        const CopiedPositionsOptions& options = {});

}  // namespace egocal::detail
