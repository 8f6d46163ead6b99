// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which divisions of a drive are evidence that a mount moved.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "moves/division.hpp"

namespace egocal::detail {
namespace {

/// Blocks that each show all directions equally well: the first ten err by `noise`, the other fifty by 1, and
/// the optimum of the fifty lies at `change` in each direction.
std::vector<LinearBlock> blocks_of(double noise, double change) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<LinearBlock> blocks(60);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool first = i < 10;
    LinearBlock& block = blocks[i];
    block.H = block.root = block.inverse_root = ParameterMatrix::Identity(6, 6);
    block.g.resize(6);
    for (double& g : block.g) g = (first ? noise : 1) * normal(random) - (first ? 0 : change);
    block.time = -1 + (2 * static_cast<double>(i) + 1) / 60;
  }
  return blocks;
}

double t2(const std::vector<LinearBlock>& blocks) {
  const Part second{10, 60};
  return evidence(blocks, second, divide(blocks, second, {}), whitener(blocks)).t2;
}

TEST(Division, OptimaThatFitTheirSidesAreEvidence) {
  const std::vector<LinearBlock> blocks = blocks_of(1, 3);
  EXPECT_TRUE(divide(blocks, {10, 60}, {}).fits);
  EXPECT_GT(t2(blocks), 100);
}

TEST(Division, ASideWhoseBlocksAllFitBadlyIsNone) {
  const std::vector<LinearBlock> blocks = blocks_of(10, 5);
  EXPECT_FALSE(divide(blocks, {10, 60}, {}).fits);
  EXPECT_EQ(t2(blocks), 0);
}

TEST(Division, UnlessTheOptimumOfTheOtherSideFitsThemFarWorse) {
  // as after a turn by several degrees, where what is not linear in the turn is above the noise
  const std::vector<LinearBlock> blocks = blocks_of(10, 50);
  EXPECT_TRUE(divide(blocks, {10, 60}, {}).fits);
  EXPECT_GT(t2(blocks), 100);
  ChangeTestOptions never;
  never.own_part = 0;
  EXPECT_FALSE(divide(blocks, {10, 60}, never).fits);
}

}  // namespace
}  // namespace egocal::detail
