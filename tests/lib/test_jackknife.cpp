// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal {
namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;
using testing::displacement;
using testing::Random;

Problem noisy_problem(std::uint64_t seed, Balance balance) {
  Random random(seed);
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  BlockStatistics blocks;
  for (const MotionPair& pair : testing::random_pairs(T, {.pairs = 300, .noise = 0.02}, random))
    blocks.add(pair);
  Problem problem;
  problem.balance = balance;
  problem.blocks = blocks.inliers();
  return problem;
}

/// The Newton step from q by the matrices themselves: sum the rest, T'ZT, T'Zq. Lengths are counted in
/// length_scale() of the whole, which the least squares multipliers depend on.
Vector6d step_by_matrices(const Problem& problem, const Statistics& rest, const DualQuaternion& q_metres) {
  const double length = detail::length_scale(cost_matrix(problem));
  const Matrix8d Q = detail::in_units_of(length, cost_matrix(rest, problem.balance));
  const DualQuaternion q = detail::in_units_of(length, q_metres);
  const Matrix8d Z = lagrangian_matrix(Q, least_squares_multipliers(Q, q));
  const Matrix86d T = detail::frame_a_basis(q);
  Vector6d step = -Matrix6d(T.transpose() * Z * T).fullPivLu().solve(Vector6d(T.transpose() * Z * q.vec()));
  step.head<3>() *= length;
  return step;
}

/// Blocks are projected once and subtracted as 6 x 6 forms; also where blocks touch, and a last one with a
/// negative weight takes off what is in two of them.
TEST(Jackknife, LeavingOutABlockIsANewtonStepOnTheRest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const bool touching : {false, true}) {
      Problem problem = noisy_problem(seed, {1, seed % 2 == 0 ? 0.01 : 3});
      if (touching) {
        Statistics shared = problem.blocks[3];
        problem.blocks[4] += shared;
        shared.dual_rows *= -1;
        shared.weight *= -1;
        problem.blocks.push_back(shared);
      }
      const DualQuaternion q = solve(problem, Method::dual).T_a_b;
      const std::vector<Vector6d> steps = leave_out_differences(problem, cost_matrix(problem), q);
      ASSERT_EQ(steps.size(), problem.blocks.size() - (touching ? 1 : 0));
      for (std::size_t i = 0; i < steps.size(); ++i) {
        Statistics rest;
        for (std::size_t k = 0; k < problem.blocks.size(); ++k)
          if (k != i) rest += problem.blocks[k];
        const Vector6d expected = step_by_matrices(problem, rest, q);
        EXPECT_LT((steps[i] - expected).norm(), 1e-8 * expected.norm()) << seed << " block " << i;
      }
    }
}

/// Where there is no noise the spreads of all settings are rounding, and the logarithm of rounding is a draw:
/// it must not decide, and single steps judge outliers best.
TEST(Jackknife, WithoutNoiseSingleStepsWithEqualWeightsAreChosen) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SimulationOptions options;
    options.terrain = Terrain::free;
    options.poses = 151;
    options.seed = seed;
    const testing::Streams s = testing::simulated_drive(options);
    const Choice choice = paired({}, s.a, s.b).choice();
    EXPECT_EQ(choice.stride, 1) << seed;
    EXPECT_EQ(choice.balance.translation, 1) << seed;
  }
}

}  // namespace
}  // namespace egocal
