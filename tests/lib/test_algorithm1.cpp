// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/algorithm1.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal::test_algorithm1 {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

/// A drive, pair by pair.
struct MotionPairing {
  DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  std::vector<MotionPair> pairs;
  BlockStatistics blocks;

  MotionPairing() {
    Random random(1);
    pairs = random_pairs(T, {.motion = testing::Motion::dominant_axis, .pairs = 300, .noise = 0.01}, random);
  }
  Problem next(std::size_t i) {
    blocks.add(pairs[i]);
    Problem problem;
    problem.blocks = blocks.inliers();
    return problem;
  }
};

TEST(Calibrate, BeginsWithTheGlobalSolverAndThenRunsFastAndCertified) {
  MotionPairing drive;
  OnlineState state;
  const OnlineOptions options{.t_no_fail = 2};
  std::int64_t last_global = -1;
  for (std::size_t i = 0; i < drive.pairs.size(); ++i) {
    const Problem problem = drive.next(i);
    const auto time = static_cast<std::int64_t>(i) * 100'000;
    const OnlineStep step = algorithm1_step(problem, time, state, options);
    if (i == 0) {
      EXPECT_TRUE(step.global_used);
    }
    if (step.global_used) last_global = time;
    // whichever solver answered, it is the global answer
    if (i >= 10) {
      EXPECT_EQ(step.answer.certificate.optimality, Optimality::certified) << i;
      const Answer global = solve(problem, Method::dual);
      EXPECT_LT(extrinsic_error(global.T_a_b, step.answer.T_a_b).translation, 1e-6) << i;
    }
    state = step.state;
  }
  EXPECT_GE(last_global, 2'000'000);
  EXPECT_LT(last_global, 10'000'000);
  EXPECT_LT(extrinsic_error(drive.T, state.last.value()).rotation, 0.05);
}

TEST(Calibrate, AWrongLastAnswerIsCaughtAndRepaired) {
  MotionPairing drive;
  Problem problem;
  for (std::size_t i = 0; i < 200; ++i) problem = drive.next(i);
  Random random(2);
  int caught = 0;
  for (int i = 0; i < 200; ++i) {
    OnlineState state;
    state.last = testing::random_extrinsic(random, 50);
    const OnlineStep step = algorithm1_step(problem, 1'000'000'000, state);
    EXPECT_EQ(step.answer.certificate.optimality, Optimality::certified);
    if (!step.fast_verified) {
      ++caught;
      EXPECT_TRUE(step.global_used);
      EXPECT_EQ(step.state.last_local_error_us, 1'000'000'000);
    }
  }
  EXPECT_GT(caught, 0);
}

TEST(Calibrate, GlobalIsAskedUntilTNoFailHasPassed) {
  MotionPairing drive;
  Problem problem;
  for (std::size_t i = 0; i < 200; ++i) problem = drive.next(i);
  OnlineState state;
  const OnlineOptions options{.t_no_fail = 1};
  state = algorithm1_step(problem, 0, state, options).state;
  EXPECT_TRUE(algorithm1_step(problem, 1'000'000, state, options).global_used);
  EXPECT_FALSE(algorithm1_step(problem, 1'000'001, state, options).global_used);
}

TEST(Calibrate, IsPure) {
  MotionPairing drive;
  Problem problem;
  for (std::size_t i = 0; i < 50; ++i) problem = drive.next(i);
  OnlineState state;
  state.last = drive.T;
  const OnlineStep first = algorithm1_step(problem, 5, state), second = algorithm1_step(problem, 5, state);
  EXPECT_EQ(first.answer.T_a_b.vec(), second.answer.T_a_b.vec());
  EXPECT_EQ(first.answer.observability.stddev, second.answer.observability.stddev);
}

TEST(WhichCounts, NewestThenCertifiedThenCheapest) {
  const AnswerRank old{1, 5, Optimality::certified, 1}, recent{1, 6, Optimality::undecided, 9};
  const AnswerRank other_session{2, 1, Optimality::not_optimal, 99};
  EXPECT_TRUE(outranks(recent, old));
  EXPECT_TRUE(outranks(other_session, recent));
  EXPECT_TRUE(outranks({1, 5, Optimality::certified, 2}, {1, 5, Optimality::undecided, 1}));
  EXPECT_TRUE(outranks({1, 5, Optimality::certified, 1}, {1, 5, Optimality::certified, 2}));
  EXPECT_FALSE(outranks(old, old));
}

}  // namespace
}  // namespace egocal::test_algorithm1
