// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/sdp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>

#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::test_sdp {
namespace {

using testing::cost_of;
using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_extrinsic;
using testing::random_pairs;
using testing::RandomDrive;

TEST(Sdp, FindsTheTruthWithoutNoise) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const Solution solution = solve_sdp(cost_of(random_pairs(T, {.pairs = 20, .flip_signs = true}, random)));
    const ExtrinsicError error = extrinsic_error(T, solution.q);
    EXPECT_LT(error.rotation, 1e-9) << seed;
    EXPECT_LT(error.translation, 1e-9) << seed;
    EXPECT_EQ(solution.status, SolverStatus::converged) << seed;
  }
}

TEST(Sdp, FindsHalfTurnMounts) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const DualQuaternion T = displacement(std::numbers::pi * random.direction(), random.normal3(2));
    const Solution solution = solve_sdp(cost_of(random_pairs(T, {.pairs = 20, .flip_signs = true}, random)));
    EXPECT_LT(extrinsic_error(T, solution.q).rotation, 1e-9) << seed;
    EXPECT_LT(extrinsic_error(T, solution.q).translation, 1e-9) << seed;
  }
}

TEST(Sdp, AgreesWithTheLineSearchOnWellConditionedProblems) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    RandomDrive drive{
        .pairs = 3 + random.below(200), .noise = random.log_uniform(1e-4, 0.5), .flip_signs = true};
    const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), drive, random));
    const Solution sdp = solve_sdp(Q), dual = solve_dual(Q);
    const ExtrinsicError difference = extrinsic_error(dual.q, sdp.q);
    EXPECT_LT(difference.rotation, 1e-9) << seed;
    EXPECT_LT(difference.translation, 1e-9) << seed;
  }
}

TEST(Sdp, MultipliersAreFeasibleAndMeetTheCost) {
  // (22b), and no duality gap: m = 2 constraints leave an optimal X of rank one
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    RandomDrive drive{.pairs = 50, .noise = random.log_uniform(1e-3, 0.5)};
    const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), drive, random));
    const Solution solution = solve_sdp(Q);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 8, 8>> Z(lagrangian_matrix(Q, solution.lambda),
                                                                       Eigen::EigenvaluesOnly);
    EXPECT_GT(Z.eigenvalues()[0], -1e-12 * Q.trace()) << seed;
    EXPECT_NEAR(solution.lambda.norm, solution.cost, 1e-11 * Q.trace()) << seed;
  }
}

TEST(Sdp, DoesNotDependOnTheUnitOfLength) {
  Random random(7);
  const DualQuaternion T = random_extrinsic(random, 100);
  const auto pairs = random_pairs(T, {.pairs = 100, .noise = 0.01}, random);
  const Solution metres = solve_sdp(cost_of(pairs));
  auto scaled = pairs;
  for (MotionPair& pair : scaled) {
    pair.a.dual *= 1000;
    pair.b.dual *= 1000;
  }
  // the dual rows in mm weigh 1e6 times as much: undo that
  const Solution millimetres = solve_sdp(cost_of(scaled, {.rotation = 1e6, .translation = 1}));
  const DualQuaternion back{millimetres.q.real, millimetres.q.dual / 1000};
  EXPECT_LT(extrinsic_error(metres.q, back).rotation, 1e-10);
  EXPECT_LT(extrinsic_error(metres.q, back).translation, 1e-8);
}

TEST(Sdp, DegenerateProblemsGiveAFiniteOptimum) {
  for (const Motion motion : {Motion::planar, Motion::single_axis, Motion::translation}) {
    for (const double noise : {0.0, 1e-9, 1e-3}) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const DualQuaternion T = random_extrinsic(random);
        const Matrix8d Q = cost_of(random_pairs(T, {.motion = motion, .pairs = 30, .noise = noise}, random));
        const Solution solution = solve_sdp(Q);
        EXPECT_TRUE(solution.q.vec().allFinite());
        EXPECT_LT(constraints(solution.q).norm(), 1e-12 * (1 + solution.q.dual.norm()));
        EXPECT_LE(solution.cost, cost(Q, T) + 1e-13 * Q.trace()) << seed << ' ' << noise;
      }
    }
  }
}

TEST(Sdp, RefusesWhatIsNotANumberAndSaysWhereNothingMoves) {
  Matrix8d Q = Matrix8d::Identity();
  Q(3, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_sdp(Q).status, SolverStatus::not_finite);
  EXPECT_TRUE(solve_sdp(Q).q.vec().allFinite());
  EXPECT_EQ(solve_sdp(Matrix8d::Zero()).status, SolverStatus::degenerate);
  EXPECT_TRUE(solve_sdp(Matrix8d::Zero()).q.vec().allFinite());
}

TEST(Sdp, GivesTheSameBitsEveryTime) {
  Random random(3);
  const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), {.noise = 0.1}, random));
  const Solution first = solve_sdp(Q);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(solve_sdp(Q).q.vec(), first.q.vec());
}

}  // namespace
}  // namespace egocal::test_sdp
