// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/weighted_blocks.hpp"

#include <array>

#include "egocal/estimation/stride_blocks.hpp"
#include "estimation/block_of.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

bool WeightedBlocks::has_room(std::uint64_t index) const {
  return index / state_.block_length < StrideBlocks::most_blocks;
}

void WeightedBlocks::add_instant(std::uint64_t index) {
  const std::size_t block = detail::block_of(index, state_.block_length);
  while (state_.blocks.size() <= block) {
    state_.blocks.emplace_back();
    state_.left_out.push_back(0);
  }
  ++state_.blocks[block].count;
}

void WeightedBlocks::add(std::uint64_t first_index, std::uint64_t last_index,
                         const detail::MotionSquare& square, MotionWeights weights, bool rotation_only) {
  if (!(weights.rotation > 0) && !(weights.translation > 0)) return;
  const std::size_t first = detail::block_of(first_index, state_.block_length),
                    last = detail::block_of(last_index, state_.block_length);
  if (state_.left_out[first] != 0 || state_.left_out[last] != 0) return;
  const double translation = weights.certainty * weights.translation;
  const detail::SquareWeights of_square{weights.certainty * weights.rotation, translation, rotation_only};
  Statistics &begin = state_.blocks[first], &end = state_.blocks[last];
  begin.weight += translation;
  if (first == last) return square.add_weighted_to(std::array{&begin.dual_rows}, of_square);
  end.weight += translation;
  state_.shared.weight += translation;
  square.add_weighted_to(std::array{&begin.dual_rows, &end.dual_rows, &state_.shared.dual_rows}, of_square);
}

void WeightedBlocks::fill(Problem& problem) const {
  problem.balance = {0, 1};  // the blocks are weighted already
  problem.blocks.clear();
  for (const Statistics& block : state_.blocks)
    if (block.weight > 0) problem.blocks.push_back(block);
  if (!(state_.shared.weight > 0)) return;
  Statistics taken_off = state_.shared;
  taken_off.dual_rows *= -1;
  taken_off.weight *= -1;
  problem.blocks.push_back(taken_off);
}

}  // namespace egocal
