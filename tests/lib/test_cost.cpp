// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "../support/random_motion.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::test_cost {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;
using testing::RandomDrive;

const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});

TEST(Cost, IsTheResidualOf14) {
  Random random(1);
  for (const MotionPair& pair : random_pairs(T_a_b, {.pairs = 20, .noise = 0.3}, random)) {
    const DualQuaternion q = testing::normal_displacement(random);
    const Vector8d residual = (q * canonical_sign(pair.b)).vec() - (canonical_sign(pair.a) * q).vec();
    const Vector8d w = (Vector8d() << 1, 2, 3, 4, 0.5, 0.6, 0.7, 0.8).finished();
    EXPECT_NEAR(cost(pair_cost(pair.a, pair.b), q), residual.squaredNorm(), 1e-12);
    EXPECT_NEAR(cost(pair_cost(pair.a, pair.b, w), q), (w.array() * residual.array().square()).sum(),
                1e-12);  // (15)
  }
}

TEST(Cost, EveryBalanceComesFromTheSame36Numbers) {
  Random random(2);
  const auto pairs = random_pairs(T_a_b, {.pairs = 50, .noise = 0.2}, random);
  const Balance balance{3, 0.02};
  Vector8d w;
  w << Eigen::Vector4d::Constant(balance.rotation), Eigen::Vector4d::Constant(balance.translation);
  Statistics statistics;
  Matrix8d direct = Matrix8d::Zero();
  for (const MotionPair& pair : pairs) {
    statistics.add(pair);
    direct += pair_cost(pair.a, pair.b, w) / 50;  // (16), eta = 1/n
  }
  EXPECT_LT((cost_matrix(statistics, balance) - direct).cwiseAbs().maxCoeff(), 1e-13 * direct.trace());
}

TEST(Cost, TruthCostsNothingAndEveryWrongConventionDoes) {
  Random random(3);
  Statistics statistics;
  for (const MotionPair& pair : random_pairs(T_a_b, {.pairs = 20}, random)) statistics.add(pair);
  const Matrix8d Q = cost_matrix(statistics);
  EXPECT_LT(cost(Q, T_a_b), 1e-15);
  // the inverse direction, the translation not rotated, quaternions x y z w, the handedness of the rotation
  const Pose T = to_pose(T_a_b);
  const DualQuaternion wrong[] = {
      conjugate(T_a_b),
      to_dual_quaternion({T.rotation, T.rotation.conjugate() * T.translation}),
      to_dual_quaternion({T.rotation.conjugate(), T.translation}),
      to_dual_quaternion({T.rotation, -T.translation}),
      to_dual_quaternion({Eigen::Quaterniond(T.rotation.z(), T.rotation.w(), T.rotation.x(), T.rotation.y()),
                          T.translation}),
      {T_a_b.real,
       quaternion_product(T_a_b.real, quaternion_product(T_a_b.dual, quaternion_conjugate(T_a_b.real)))},
  };
  for (const DualQuaternion& q : wrong) EXPECT_GT(cost(Q, q), 1e-4);
}

TEST(Cost, SignsOfTheMotionsDoNotMatter) {
  Random random(4), same(4);
  Statistics flipped, plain;
  for (const MotionPair& pair :
       random_pairs(T_a_b, {.pairs = 100, .noise = 0.05, .flip_signs = true}, random)) {
    flipped.add(pair);
    plain.add(canonical_sign(pair.a), canonical_sign(pair.b));
  }
  EXPECT_EQ(flipped.dual_rows, plain.dual_rows);
}

TEST(Cost, UnequalEtaAreNormalised) {
  Random random(5);
  const auto pairs = random_pairs(T_a_b, {.pairs = 10, .noise = 0.1}, random);
  Statistics once, scaled;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    once.add(pairs[i].a, pairs[i].b, 1.0 + static_cast<double>(i));
    scaled.add(pairs[i].a, pairs[i].b, 1000 * (1.0 + static_cast<double>(i)));
  }
  EXPECT_LT((cost_matrix(once) - cost_matrix(scaled)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Cost, AMillionPairsLoseNothing) {
  Random random(6);
  const auto pairs = random_pairs(T_a_b, {.pairs = 1000, .noise = 0.1}, random);
  BlockStatistics blocks;
  Eigen::Matrix<long double, 8, 8> exact = Eigen::Matrix<long double, 8, 8>::Zero();
  for (int round = 0; round < 1000; ++round)
    for (const MotionPair& pair : pairs) blocks.add(pair);
  for (const MotionPair& pair : pairs) {
    Statistics one;
    one.add(pair);
    exact += one.dual_rows.cast<long double>() * 1000.0L;
  }
  const Statistics all = sum_blocks(blocks.inliers());
  EXPECT_EQ(all.count, 1000000u);
  EXPECT_LT((all.dual_rows.cast<long double>() - exact).cwiseAbs().maxCoeff() / exact.trace(), 1e-13L);
}

TEST(Constraints, LagrangianIsTheQuadraticFormOf21) {
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    const Vector8d v = Vector8d::NullaryExpr([&] { return random.normal(); });
    const DualQuaternion q = DualQuaternion::from_vec(v);
    Matrix8d Q = Matrix8d::NullaryExpr([&] { return random.normal(); });
    Q = (Q * Q.transpose()).eval();
    const Multipliers lambda{random.normal(), random.normal()};
    const Eigen::Vector2d g = constraints(q);
    EXPECT_NEAR(lagrangian(Q, q, lambda), v.dot(Q * v) + lambda.norm * g[0] + lambda.orthogonal * g[1],
                1e-10);  // (19)
  }
}

TEST(Constraints, LeastSquaresMultipliersMinimise28) {
  Random random(10);
  Matrix8d Q = Matrix8d::NullaryExpr([&] { return random.normal(); });
  Q = (Q * Q.transpose()).eval();
  const DualQuaternion q = testing::normal_displacement(random);
  const Multipliers best = least_squares_multipliers(Q, q);
  const auto residual = [&](double a, double b) {
    return (lagrangian_matrix(Q, {best.norm + a, best.orthogonal + b}) * q.vec()).norm();
  };
  for (const double step : {1e-3, -1e-3}) {
    EXPECT_GT(residual(step, 0), residual(0, 0));
    EXPECT_GT(residual(0, step), residual(0, 0));
  }
}

TEST(Constraints, PlanarOnesVanishOnPlanarDisplacementsOnly) {
  EXPECT_LT(planar_constraints(displacement({0, 0, 0.7}, {1, 2, 0})).norm(), 1e-15);
  EXPECT_GT(planar_constraints(displacement({0, 0, 0.7}, {1, 2, 0.1})).norm(), 1e-3);
  EXPECT_GT(planar_constraints(displacement({0, 0.1, 0.7}, {1, 2, 0})).norm(), 1e-3);
}

}  // namespace
}  // namespace egocal::test_cost
