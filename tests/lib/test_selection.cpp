// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The choice between motions of several strides.
#include <gtest/gtest.h>

#include "../support/random_motion.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

std::vector<Statistics> blocks_of(const DualQuaternion& T, std::size_t pairs, double noise,
                                  std::uint64_t seed) {
  Random random(seed);
  BlockStatistics blocks;
  for (const MotionPair& pair : random_pairs(T, {.pairs = pairs, .noise = noise}, random)) blocks.add(pair);
  return blocks.inliers();
}

/// Which of three strides is chosen where steps are precise but see another extrinsic.
int chosen_stride(const Eigen::Vector3d& error_of_steps, std::uint64_t seed) {
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  const DualQuaternion of_steps = displacement({0, 0, 0}, error_of_steps) * T;
  const std::vector<Candidate> candidates = {{1, {1, 1}, blocks_of(of_steps, 1200, 0.002, 3 * seed)},
                                             {2, {1, 1}, blocks_of(T, 600, 0.01, 3 * seed + 1)},
                                             {4, {1, 1}, blocks_of(T, 300, 0.02, 3 * seed + 2)}};
  const std::optional<Selection> selection = select_candidate({}, candidates, std::nullopt);
  return selection ? candidates[selection->index].stride : 0;
}

TEST(Selection, PreciseStepsAreTakenWhereLongerMotionsAgree) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_EQ(chosen_stride({0, 0, 0}, seed), 1) << seed;
}

TEST(Selection, StepsThatLongerMotionsContradictAreRefused) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_GT(chosen_stride({0, 0, 0.06}, seed), 1) << seed;
}

}  // namespace
}  // namespace egocal
