// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "../support/random_motion.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal::test_blocks {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});

std::vector<MotionPair> some_pairs(std::uint64_t count) {
  Random random(7);
  return random_pairs(T_a_b, {.pairs = count, .noise = 0.1}, random);
}

TEST(BlockStatistics, StayBoundedMergeNeighboursAndKeepTheSum) {
  BlockStatistics blocks;
  Statistics sum;
  for (const MotionPair& pair : some_pairs(5000)) {
    blocks.add(pair);
    sum.add(pair);
    const auto& state = blocks.state();
    ASSERT_LE(state.blocks.size(), BlockStatistics::max_blocks);
    for (std::size_t i = 0; i + 1 < state.blocks.size(); ++i)
      ASSERT_EQ(state.blocks[i].statistics.count, state.pairs_per_block);
    ASSERT_LE(blocks.inliers().size(), BlockStatistics::max_inlier_blocks);
    ASSERT_EQ(sum_blocks(blocks.inliers()).count, sum.count);
  }
  EXPECT_GT(blocks.inliers().size(), BlockStatistics::max_inlier_blocks / 2);
  EXPECT_LT((sum_blocks(blocks.inliers()).dual_rows - sum.dual_rows).cwiseAbs().maxCoeff(),
            1e-12 * sum.dual_rows.trace());
}

TEST(BlockStatistics, VerdictsStayApartWhenBlocksMergeAndNothingIsLost) {
  Random random(8);
  BlockStatistics blocks;
  Statistics kept, left_out;
  for (const MotionPair& pair : some_pairs(3000)) {
    const bool bad = random.uniform() < 0.3;
    blocks.add(pair, bad);
    (bad ? left_out : kept).add(pair);
    ASSERT_LE(blocks.state().blocks.size(), BlockStatistics::max_blocks);
    ASSERT_EQ(blocks.inlier_pairs(), kept.count);
  }
  EXPECT_LT((sum_blocks(blocks.inliers()).dual_rows - kept.dual_rows).cwiseAbs().maxCoeff(),
            1e-12 * kept.dual_rows.trace());
  // a verdict can be revised: everything comes back
  blocks.leave_out(std::vector<bool>(blocks.state().blocks.size(), false));
  EXPECT_EQ(blocks.inlier_pairs(), kept.count + left_out.count);
  Statistics all = kept;
  all += left_out;
  EXPECT_LT((sum_blocks(blocks.inliers()).dual_rows - all.dual_rows).cwiseAbs().maxCoeff(),
            1e-12 * all.dual_rows.trace());
}

TEST(BlockStatistics, ContinueFromTheirStateBitForBit) {
  const std::vector<MotionPair> pairs = some_pairs(777);
  for (const std::size_t cut : {1u, 31u, 32u, 33u, 64u, 65u, 500u}) {
    BlockStatistics whole, first;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      whole.add(pairs[i], i % 7 == 0);
      if (i < cut) first.add(pairs[i], i % 7 == 0);
    }
    BlockStatistics second(first.state());
    for (std::size_t i = cut; i < pairs.size(); ++i) second.add(pairs[i], i % 7 == 0);
    const std::vector<Statistics> expected = whole.inliers(), kept = second.inliers();
    ASSERT_EQ(kept.size(), expected.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
      ASSERT_EQ(kept[i].dual_rows, expected[i].dual_rows) << "cut " << cut << " block " << i;
  }
}

}  // namespace
}  // namespace egocal::test_blocks
