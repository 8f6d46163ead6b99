// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Proofs of the choice of outliers (the large study is tests/bench/outlier_proof_study.cpp).
#include <gtest/gtest.h>

#include "../support/simulated_drive.hpp"
#include "../support/truncated_problems.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_outlier_proof {
namespace {

using testing::Random;
using testing::TruncatedDrive;
using testing::TruncatedProblem;

TEST(OutlierProof, OfDrivesWithAndWithoutOutliers) {
  for (const testing::Motion motion : {testing::Motion::dominant_axis, testing::Motion::free})
    for (const double outliers : {0.0, 0.05}) {
      TruncatedDrive drive;
      drive.motion = motion;
      drive.blocks = 64;
      drive.outliers = outliers;
      Random random(5);
      for (int i = 0; i < 5; ++i) {
        const TruncatedProblem problem = testing::truncated_problem(drive, random);
        const auto choice = testing::settled_choice(problem.parts, problem.wrong);
        ASSERT_TRUE(choice);
        EXPECT_EQ(prove_outliers(problem.parts, *choice).choice, OutlierChoice::proven);
      }
    }
}

TEST(OutlierProof, NeverOfALocalMinimum) {
  // two extrinsics, one of them in a quarter of the blocks: choosing the minority is a local minimum
  Random random(3);
  int refuted = 0;
  for (int i = 0; i < 20; ++i) {
    TruncatedDrive drive;
    drive.outliers = 0;
    drive.blocks = 12;
    const DualQuaternion T = testing::random_extrinsic(random, 0.5);
    const DualQuaternion other = T * testing::normal_displacement(random, 0.5, 0.5);
    TruncatedProblem problem;
    std::vector<bool> minority;
    for (std::size_t k = 0; k < 16; ++k) {
      testing::RandomDrive block;
      block.pairs = 16;
      block.noise = 0.02;
      minority.push_back(k >= 4);
      problem.parts.push_back({testing::cost_of(testing::random_pairs(k < 4 ? other : T, block, random)), 0});
      problem.parts.back().limit = 10 * cost(problem.parts.back().Q, k < 4 ? other : T);
    }
    const auto choice = testing::settled_choice(problem.parts, minority);
    ASSERT_TRUE(choice);
    const OutlierProof proof = prove_outliers(problem.parts, *choice);
    EXPECT_NE(proof.choice, OutlierChoice::proven);
    if (proof.choice != OutlierChoice::not_best) continue;
    ++refuted;
    const DualQuaternion better = testing::minimum_without(problem.parts, proof.better);
    EXPECT_LT(testing::truncated_cost(problem.parts, better),
              testing::truncated_cost(problem.parts, testing::minimum_without(problem.parts, *choice)));
  }
  EXPECT_GT(refuted, 0);
}

TEST(OutlierProof, NotOfAChoiceThatItsOwnLimitsContradict) {
  Random random(9);
  TruncatedDrive drive;
  drive.outliers = 0;
  const TruncatedProblem problem = testing::truncated_problem(drive, random);
  std::vector<bool> outlier(problem.parts.size(), false);
  EXPECT_EQ(prove_outliers(problem.parts, outlier).choice, OutlierChoice::proven);
  outlier[3] = true;  // fits, and is omitted all the same
  EXPECT_EQ(prove_outliers(problem.parts, outlier).choice, OutlierChoice::not_proven);
}

TEST(OutlierProof, NotWhereTheMotionsShowNothing) {
  Random random(2);
  for (const testing::Motion motion : {testing::Motion::translation, testing::Motion::single_axis}) {
    TruncatedDrive drive;
    drive.motion = motion;
    drive.noise = 0;
    TruncatedProblem problem = testing::truncated_problem(drive, random);
    for (TruncatedPart& part : problem.parts) part.limit = 1;
    EXPECT_NE(prove_outliers(problem.parts, std::vector<bool>(problem.parts.size(), false)).choice,
              OutlierChoice::not_best);
  }
  EXPECT_NE(prove_outliers(std::vector<TruncatedPart>(4, {Matrix8d::Zero(), 1}), std::vector<bool>(4, false))
                .choice,
            OutlierChoice::not_best);
}

TEST(OutlierProof, OfCalibrations) {
  int proven = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const testing::Streams streams =
        testing::simulated_drive({.terrain = Terrain::rough, .relative_noise = 0.01, .seed = seed});
    const Calibration found = calibrate(streams.a, streams.b);
    ASSERT_TRUE(found.outliers);
    proven += found.outliers->choice == OutlierChoice::proven ? 1 : 0;
  }
  EXPECT_GE(proven, 4);
}

}  // namespace
}  // namespace egocal::test_outlier_proof
