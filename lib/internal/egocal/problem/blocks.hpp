// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/problem/cost.hpp"

namespace egocal {

namespace detail {
class MotionSquare;
}

/// Statistics in consecutive blocks of equal length, bounded however long the drive: when max_blocks are
/// full, neighbours are merged and blocks become twice as long. Blocks can be rejected, as contradicting the
/// others; those merge among themselves, so that nothing is lost and a verdict can be revised.
class BlockStatistics {
 public:
  static constexpr std::size_t max_blocks = 64;  ///< format: of state and messages
  /// Most blocks that inliers() returns: what a message carries and the jack-knife omits one by one.
  static constexpr std::size_t max_inlier_blocks = 32;

  struct Block {
    Statistics statistics;
    bool outlier = false;
  };
  /// All there is; continuing from a copy gives the same bits.
  struct State {
    std::vector<Block> blocks;  ///< never empty ones
    std::uint64_t pairs_per_block = 1;
  };

  BlockStatistics() = default;
  explicit BlockStatistics(State state) : state_(std::move(state)) {}

  /// Adds a motion to the newest block of that verdict.
  void add(const MotionPair& pair, bool outlier = false);
  /// Adds a motion of weight one to the newest block that is no outlier.
  void add(const detail::MotionSquare& motion);
  /// Omits the blocks that are outliers: one verdict a block.
  void leave_out(const std::vector<bool>& verdicts);

  /// The blocks that are not omitted, neighbours joined where there are more than max_inlier_blocks.
  std::vector<Statistics> inliers() const;
  std::uint64_t inlier_pairs() const;
  const State& state() const { return state_; }

 private:
  Statistics& newest(bool outlier);

  State state_;
};

}  // namespace egocal
