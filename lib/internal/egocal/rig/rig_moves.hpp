// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/moves/find_moves.hpp"
#include "egocal/rig/rig.hpp"

namespace egocal {

struct RigMovesOptions {
  MovesOptions moves;
  /// Changes of several pairs are one where their intervals, widened by this on both sides, overlap [s].
  double same_time = 5;
  /// A sensor is named where the evidence of its pairs exceeds that of every other sensor's by this many
  /// decades of chance. Two: one in a hundred.
  double least_lead = 2;
  /// Evidence of one pair counts up to this many decades: smaller chances are rounding.
  double most_decades = 30;
};

/// What the diagnosis of a pair by itself (diagnosis/mount/mount.hpp) says of its mount.
struct ShownMove {
  std::size_t pair = 0;  ///< index
  double time = 0;       ///< [s] from the begin of the pair's first motion
};

/// One change of the rig, as its pairs see it.
struct RigMove {
  MoveKind kind = MoveKind::bump;
  double time = 0, earliest = 0, latest = 0;  ///< as in Move, of the pair that shows it best [s]
  std::optional<std::size_t> sensor;  ///< that moved; empty with two sensors, or where it is not clear
  std::size_t pair = 0;               ///< index of the pair that shows it best
  Move move;                          ///< of that pair
};

/// Whether and when a mount of the rig moved, and which. pairs: of the same intervals (rig_motions()). shown:
/// only what some pair's own diagnosis shows, at the same time, is a move of the rig: it asks more than these
/// motions do (other strides, no correction of an odometry). In the order of time. Throws nothing.
std::vector<RigMove> find_rig_moves(std::size_t sensors, std::span<const RigPair> pairs,
                                    std::span<const ShownMove> shown, const RigMovesOptions& options = {});

}  // namespace egocal
