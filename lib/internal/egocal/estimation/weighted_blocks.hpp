// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

namespace detail {
class MotionSquare;
}

/// Weights of one motion, per motion: of the real rows [1/rad^2] and of the dual rows [1/m^2], up to a common
/// factor.
struct MotionWeights {
  double rotation = 0;
  double translation = 0;
  double certainty = 1;  ///< of this motion among those of its stride
};

/// A weighted sum of motions of many strides in touching blocks of instants. Every block holds each motion
/// with an end in it; what is in two of them is kept once more, to be taken off. So the sum of the blocks
/// less what is shared is the whole, and omitting a block omits every motion that touches it.
class WeightedBlocks {
 public:
  /// All there is; continuing from a copy gives the same bits.
  struct State {
    std::uint64_t block_length = 1;      ///< instants
    std::vector<Statistics> blocks;      ///< count: instants of the block
    std::vector<std::uint8_t> left_out;  ///< per block: contradicts the others
    Statistics shared;
  };

  WeightedBlocks() = default;
  explicit WeightedBlocks(State state) : state_(std::move(state)) {}

  /// Whether the block of this instant exists or may be opened.
  bool has_room(std::uint64_t index) const;
  /// Opens the block that the instant with this index belongs to.
  void add_instant(std::uint64_t index);
  /// A motion between two instants that were added, where neither of their blocks is omitted. rotation_only:
  /// it spans a jump of a translation.
  void add(std::uint64_t first_index, std::uint64_t last_index, const detail::MotionSquare& motion,
           MotionWeights weights, bool rotation_only);

  /// Sets blocks and balance of a problem. Where motions are shared the last block has a negative weight and
  /// takes them off.
  void fill(Problem& problem) const;
  const State& state() const { return state_; }

 private:
  State state_;
};

}  // namespace egocal
