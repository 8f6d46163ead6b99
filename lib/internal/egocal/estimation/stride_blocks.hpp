// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/estimation/weighted_blocks.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

namespace detail {
class MotionSquare;
}

/// Motions that begin in one block of instants and end in another (or the same).
struct StrideCell {
  Statistics motions;    ///< that count in rotation and translation
  Statistics rotations;  ///< that count in rotation only: they span a jump of a translation
};

/// Statistics of the motions of one stride, by the blocks of instants they begin and end in. A motion of s
/// steps ends s / L or s / L + 1 blocks of L instants later.
struct StrideSum {
  int stride = 1;
  std::vector<StrideCell> near, far;  ///< by the block of the first instant
};

/// How motions of each stride are weighted, per motion.
struct StrideWeights {
  std::vector<double> rotation;     ///< [1/rad^2], up to a common factor
  std::vector<double> translation;  ///< of the dual rows [1/m^2], up to the same factor
};

/// Statistics of motions of many strides, in blocks of instants: omitting a block of instants omits
/// every motion with an end in it, which gives long motions an honest spread. Bounded: when all blocks are in
/// use, neighbours are merged and blocks become twice as long.
class StrideBlocks {
 public:
  static constexpr std::size_t most_blocks = 32;  ///< format: of state and messages

  /// All there is; continuing from a copy gives the same bits.
  struct State {
    std::uint64_t block_length = 1;       ///< instants
    std::vector<std::uint64_t> instants;  ///< per block, those that were added
    std::vector<std::uint8_t> outlier;    ///< per block: omitted, contradicts the others
    std::vector<StrideSum> strides;       ///< ascending
  };

  StrideBlocks() = default;
  /// strides: steps of one motion, ascending.
  explicit StrideBlocks(const std::vector<int>& strides);
  explicit StrideBlocks(State state) : state_(std::move(state)) {}

  /// Opens the block that the instant with this index (counted from 0, ascending) belongs to.
  void add_instant(std::uint64_t index);
  /// Adds a motion of strides()[stride] that begins at an instant and ends at the newest one, by this weight.
  void add(std::size_t stride, std::uint64_t first_index, const detail::MotionSquare& motion,
           bool rotation_only, double weight);
  /// Omits the blocks that are outliers: one verdict a block.
  void leave_out(std::vector<std::uint8_t> outlier) { state_.outlier = std::move(outlier); }

  std::size_t blocks() const { return state_.instants.size(); }
  const std::vector<StrideSum>& strides() const { return state_.strides; }
  /// Calls visit(cell, first block, last block) for the cells that hold motions and are not omitted.
  template <typename Visit>
  void each_cell(std::size_t stride, const Visit& visit) const;
  /// Sum over the motions of one stride, without the blocks omitted.
  StrideCell total(std::size_t stride) const;
  /// Motions within one block, weighted: what the blocks say independently of each other.
  std::vector<Statistics> within(const StrideWeights& weights) const;
  const State& state() const { return state_; }

 private:
  std::size_t block_of(std::uint64_t index) const;
  void merge();

  State state_;
};

/// The sums of StrideBlocks by the blocks that a motion touches, without those omitted: made once, weighted
/// in many ways.
class TouchingSums {
 public:
  explicit TouchingSums(const StrideBlocks& blocks);

  /// Sum over the motions of one stride.
  const StrideCell& total(std::size_t stride) const { return strides_[stride].total; }
  /// The weighted sum; blocks that are omitted hold nothing.
  WeightedBlocks weighted(const StrideWeights& weights) const;

 private:
  struct PerStride {
    std::vector<Statistics> motions, rotations;  ///< by block; as in StrideCell. Empty: there are none
    StrideCell shared, total;
  };
  std::vector<PerStride> strides_;
  std::uint64_t block_length_ = 1;
  std::vector<std::uint64_t> instants_;
  std::vector<std::uint8_t> left_out_;
};

/// weights.translation of the motions plus weights.rotation of the rotations, as one Statistics: its upper
/// left block holds the rotation part as well, so the balance to use is {0, 1}.
void add_weighted(Statistics& sum, const StrideCell& cell, double rotation, double translation);

}  // namespace egocal
