// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions of one sensor in both streams, as of two attitude sensors beside one GNSS receiver.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

struct CopiedPositionsOptions {
  std::size_t looked_at = 1000;  ///< steps, evenly spread, at most
  std::size_t fewest = 20;       ///< of them, at times that both streams have
  /// Half of the distances agree to this part of them: digits of files. Two odometries agree to 1e-3 at best,
  /// and while the vehicle turns two places on it travel unlike distances.
  double of_distance = 1e-5;
  double turning = 0.01;  ///< typical angle of the motions, at least [rad]
};

/// same_stream, uncertain: between common times both streams travel the same distances to rounding. Whatever
/// the extrinsic and the axes of the world, two sensors never do. Empty where the motions turn too little, or
/// where no poses are of one time. motions: of the same instants.
std::optional<Finding> copied_positions(const Instants& instants, const Motions& motions,
                                        const CopiedPositionsOptions& options = {});

}  // namespace egocal::detail
