// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/slsqp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::test_slsqp {
namespace {

using testing::cost_of;
using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_extrinsic;
using testing::random_pairs;
using testing::random_planar_extrinsic;
using testing::RandomDrive;

/// A unit dual quaternion near q: exactly feasible, and wrong.
DualQuaternion wrong_start(const DualQuaternion& q, Random& random, double rotation, double translation) {
  return q * testing::random_displacement(random, rotation, translation);
}

TEST(Slsqp, AWrongButFeasibleWarmStartMoves) {
  // NLopt reports the best feasible iterate: with a tight constraint tolerance that is the exactly feasible
  // start
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    RandomDrive drive{.motion = seed % 2 ? Motion::free : Motion::dominant_axis,
                      .noise = random.log_uniform(1e-3, 0.1)};
    const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), drive, random));
    const DualQuaternion optimum = solve_dual(Q).q;
    const DualQuaternion start = wrong_start(optimum, random, 0.02, 0.05);
    const Solution solution = solve_slsqp(Q, start);
    EXPECT_GT(extrinsic_error(start, solution.q).rotation, 0.015) << seed;
    EXPECT_LT(solution.cost, cost(Q, start)) << seed;
    EXPECT_LT(extrinsic_error(optimum, solution.q).rotation, 1e-9) << seed;
    EXPECT_LT(extrinsic_error(optimum, solution.q).translation, 1e-9) << seed;
    EXPECT_EQ(solution.status, SolverStatus::converged) << seed;
  }
}

TEST(Slsqp, StartedAtTheSolutionItStaysThere) {
  // where NLopt throws "roundoff limited"
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const double noise = seed % 2 ? 0.01 : 0.0;
    const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), {.noise = noise}, random));
    const DualQuaternion optimum = solve_dual(Q).q;
    const Solution solution = solve_slsqp(Q, optimum);
    EXPECT_LT(extrinsic_error(optimum, solution.q).rotation, 1e-9) << seed;
    EXPECT_LT(extrinsic_error(optimum, solution.q).translation, 1e-9) << seed;
    EXPECT_EQ(solution.status, SolverStatus::converged) << seed;
  }
}

TEST(Slsqp, EveryAnswerIsAUnitDualQuaternion) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const Motion motions[] = {Motion::free, Motion::dominant_axis, Motion::planar, Motion::single_axis,
                              Motion::translation};
    RandomDrive drive{.motion = motions[seed % 5], .noise = seed % 3 ? random.log_uniform(1e-6, 0.5) : 0.0};
    const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), drive, random));
    const Solution solution = solve_slsqp(Q, random_extrinsic(random));
    EXPECT_TRUE(solution.q.vec().allFinite()) << seed;
    EXPECT_LT(constraints(solution.q).norm(), 1e-13 * (1 + solution.q.dual.norm())) << seed;
    EXPECT_NEAR(solution.cost, cost(Q, solution.q), 1e-15 * Q.trace()) << seed;
  }
}

TEST(Slsqp, AStartThatIsNoUnitDualQuaternionIsProjected) {
  Random random(1);
  const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), {.noise = 0.01}, random));
  const DualQuaternion optimum = solve_dual(Q).q;
  const DualQuaternion start{3 * optimum.real, 3 * optimum.dual + optimum.real};
  EXPECT_LT(extrinsic_error(optimum, solve_slsqp(Q, start).q).rotation, 1e-9);
  const DualQuaternion zero{Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
  EXPECT_TRUE(solve_slsqp(Q, zero).q.vec().allFinite());
  DualQuaternion nan = optimum;
  nan.dual[2] = std::nan("");
  EXPECT_TRUE(solve_slsqp(Q, nan).q.vec().allFinite());
}

TEST(Slsqp, RefusesWhatIsNotANumber) {
  // NLopt would loop for ever
  Matrix8d Q = Matrix8d::Identity();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Q(2, 6) = Q(6, 2) = bad;
    EXPECT_EQ(solve_slsqp(Q, {}).status, SolverStatus::not_finite);
    EXPECT_EQ(solve_slsqp_planar(Q, {}).status, SolverStatus::not_finite);
  }
  EXPECT_EQ(solve_slsqp(Matrix8d::Zero(), {}).status, SolverStatus::degenerate);
  EXPECT_EQ(solve_slsqp_planar(Matrix8d::Zero(), {}).status, SolverStatus::degenerate);
}

TEST(Slsqp, EndsAtItsLimitOfEvaluationsAndSaysSo) {
  Random random(5);
  const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), {.noise = 0.1}, random));
  const Solution solution = solve_slsqp(Q, random_extrinsic(random), {.max_evaluations = 3});
  EXPECT_EQ(solution.status, SolverStatus::iteration_limit);
  EXPECT_LE(solution.iterations, 4);
  EXPECT_TRUE(solution.q.vec().allFinite());
}

TEST(SlsqpPlanar, AgreesWithTheClosedForm) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    RandomDrive drive{.motion = Motion::planar, .noise = random.log_uniform(1e-4, 0.3)};
    const Matrix8d Q = cost_of(random_pairs(random_planar_extrinsic(random), drive, random));
    const DualQuaternion optimum = solve_planar(Q).q;
    const double yaw = random.uniform(-0.3, 0.3), x = random.normal(), y = random.normal();
    const DualQuaternion start = optimum * displacement({0, 0, yaw}, {x, y, 0});
    const Solution solution = solve_slsqp_planar(Q, start);
    EXPECT_LT(extrinsic_error(optimum, solution.q).rotation, 1e-9) << seed;
    EXPECT_LT(extrinsic_error(optimum, solution.q).translation, 1e-9) << seed;
    EXPECT_EQ(planar_constraints(solution.q).norm(), 0) << seed;
    EXPECT_EQ(solution.status, SolverStatus::converged) << seed;
  }
}

TEST(SlsqpPlanar, AStartOutsideThePlaneIsProjected) {
  Random random(2);
  const Matrix8d Q = cost_of(
      random_pairs(random_planar_extrinsic(random), {.motion = Motion::planar, .noise = 0.01}, random));
  const Solution upside_down = solve_slsqp_planar(Q, displacement({std::numbers::pi, 0, 0}, {1, 2, 3}));
  EXPECT_TRUE(upside_down.q.vec().allFinite());
  EXPECT_EQ(planar_constraints(upside_down.q).norm(), 0);
}

TEST(Slsqp, GivesTheSameBitsEveryTime) {
  Random random(3);
  const Matrix8d Q = cost_of(random_pairs(random_extrinsic(random), {.noise = 0.1}, random));
  const DualQuaternion start = random_extrinsic(random);
  const Solution first = solve_slsqp(Q, start);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(solve_slsqp(Q, start).q.vec(), first.q.vec());
}

}  // namespace
}  // namespace egocal::test_slsqp
