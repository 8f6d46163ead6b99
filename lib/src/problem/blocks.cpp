// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/blocks.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "problem/motion_square.hpp"

namespace egocal {

namespace {

using Block = BlockStatistics::Block;

/// Every two neighbours of the same verdict as one, where the first of them was.
std::vector<Block> merged(const std::vector<Block>& blocks) {
  std::vector<Block> result;
  std::array<std::optional<std::size_t>, 2> single;  // of either verdict, waits for its neighbour
  for (const Block& block : blocks) {
    std::optional<std::size_t>& partner = single[block.outlier ? 1 : 0];
    if (partner) {
      result[*partner].statistics += block.statistics;
      partner.reset();
    } else {
      partner = result.size();
      result.push_back(block);
    }
  }
  return result;
}

}  // namespace

/// Statistics of the newest block with this verdict, with room for one more motion.
Statistics& BlockStatistics::newest(bool outlier) {
  const auto newest = [&] {
    return std::find_if(state_.blocks.rbegin(), state_.blocks.rend(),
                        [&](const Block& block) { return block.outlier == outlier; });
  };
  const auto full = [&](const auto& block) {
    return block == state_.blocks.rend() || block->statistics.count >= state_.pairs_per_block;
  };
  if (full(newest()) && state_.blocks.size() == max_blocks) {
    state_.blocks = merged(state_.blocks);
    state_.pairs_per_block *= 2;
  }
  if (full(newest())) state_.blocks.push_back({{}, outlier});
  return newest()->statistics;
}

void BlockStatistics::add(const MotionPair& pair, bool outlier) {
  newest(outlier).add(pair);
}

void BlockStatistics::add(const detail::MotionSquare& motion) {
  Statistics& statistics = newest(false);
  motion.add_to(statistics.dual_rows);
  statistics.weight += 1;
  ++statistics.count;
}

void BlockStatistics::leave_out(const std::vector<bool>& verdicts) {
  for (std::size_t i = 0; i < state_.blocks.size(); ++i) state_.blocks[i].outlier = verdicts.at(i);
}

std::vector<Statistics> BlockStatistics::inliers() const {
  std::vector<Statistics> kept;
  kept.reserve(state_.blocks.size());
  for (const Block& block : state_.blocks)
    if (!block.outlier) kept.push_back(block.statistics);
  if (kept.size() <= max_inlier_blocks) return kept;
  std::vector<Statistics> joined;
  joined.reserve((kept.size() + 1) / 2);
  for (std::size_t i = 0; i < kept.size(); i += 2) {
    joined.push_back(kept[i]);
    if (i + 1 < kept.size()) joined.back() += kept[i + 1];
  }
  return joined;
}

std::uint64_t BlockStatistics::inlier_pairs() const {
  std::uint64_t count = 0;
  for (const Block& block : state_.blocks)
    if (!block.outlier) count += block.statistics.count;
  return count;
}

}  // namespace egocal
