// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which divisions of a drive are evidence that a mount moved.
#include <gtest/gtest.h>

#include <vector>

#include "../support/random_motion.hpp"
#include "moves/division.hpp"

namespace egocal::detail::test_division {
namespace {

/// Blocks that each show all directions equally well. To a linear model the first ten err by `noise`, the
/// other fifty by 1, and the optimum of the fifty lies at `change` in each direction. Their motions are those
/// of a mount that is turned by `turn` [rad] after the first ten.
std::vector<LinearBlock> blocks_of(double noise, double change, double turn) {
  testing::Random random(1);
  const DualQuaternion before = testing::random_extrinsic(random),
                       after = before * testing::displacement({0, 0, turn}, {0, 0, 0});
  std::vector<LinearBlock> blocks(60);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool first = i < 10;
    LinearBlock& block = blocks[i];
    block.H = block.root = block.inverse_root = ParameterMatrix::Identity(6, 6);
    block.g.resize(6);
    for (double& g : block.g) g = (first ? noise : 1) * random.normal() - (first ? 0 : change);
    block.time = -1 + (2 * static_cast<double>(i) + 1) / 60;
    Statistics motions;
    for (const MotionPair& pair :
         testing::random_pairs(first ? before : after, {.pairs = 20, .noise = 0.01}, random))
      motions.add(pair);
    block.Q = cost_matrix(motions, {});
  }
  return blocks;
}

constexpr Part second{10, 60};

double t2(const std::vector<LinearBlock>& blocks) {
  return evidence(blocks, second, divide(blocks, second, {}), whitener(blocks)).t2;
}

TEST(Division, OptimaThatFitTheirSidesAreEvidence) {
  const std::vector<LinearBlock> blocks = blocks_of(1, 3, 0);
  EXPECT_TRUE(divide(blocks, second, {}).fits);
  EXPECT_GT(t2(blocks), 100);
}

TEST(Division, ASideWhoseBlocksAllFitBadlyIsNone) {
  const std::vector<LinearBlock> blocks = blocks_of(10, 50, 0);
  EXPECT_FALSE(divide(blocks, second, {}).fits);
  EXPECT_EQ(t2(blocks), 0);
}

TEST(Division, UnlessItsMotionsFitTheOtherOptimumFarWorse) {
  // as after a turn by several degrees, where what is not linear in the turn is above the noise
  const std::vector<LinearBlock> blocks = blocks_of(10, 50, 0.1);
  EXPECT_TRUE(divide(blocks, second, {}).fits);
  EXPECT_GT(t2(blocks), 100);
  ChangeTestOptions never;
  never.own_part = 0;
  EXPECT_FALSE(divide(blocks, second, never).fits);
}

}  // namespace
}  // namespace egocal::detail::test_division
