// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that moves back and forth between two places: a loose bolt, a hinge, a gimbal.
#pragma once

#include <optional>
#include <span>

#include "moves/linear_blocks.hpp"

namespace egocal::detail {

/// Study: docs/moves.md, "Back and forth".
struct SwitchingOptions {
  double shortest_block = 1, longest_block = 8;  ///< [s]; each twice as long as the one before
  std::size_t block_pairs = 8;                   ///< in a block, at least
  std::size_t least_blocks = 20, most_blocks = 512;
  /// Squared residuals of the blocks with two extrinsics, as a part of those with one, at most. Two
  /// extrinsics leave 0.9 of white noise, 0.36 where all of it is along one direction, as where one error
  /// wanders, and 0.25 of an error that is spread evenly.
  double most_left = 0.12;
  double least_part = 0.2;         ///< of the blocks that have either extrinsic
  std::size_t least_switches = 3;  ///< from one extrinsic to the other: less is a mount that moved
  /// Squared residuals count up to this many medians.
  double longest_square = 9;
  int rounds = 30;  ///< of blocks and extrinsics in turn, at most
  ChangeTestOptions test;
};

struct Switching {
  DualQuaternion first, second;  ///< T_a_b, that of the begin of the drive first
  std::size_t switches = 0;
  double time = 0;  ///< of the first one [s], from the begin of the first motion pair
  double left = 1;  ///< as most_left
};

/// Two extrinsics between which the mount switches. Empty: one extrinsic suits the blocks, or two do not suit
/// them far better. Spatial mode only.
std::optional<Switching> find_switching(std::span<const MotionPair> pairs, const Problem& problem,
                                        const SwitchingOptions& options = {});

}  // namespace egocal::detail
