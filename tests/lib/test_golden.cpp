// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Every number on the way from motions to a proven answer, as an independent computation in 50 digits has it
// (golden/make.py).
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "../support/paths.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"

namespace egocal::test_golden {
namespace {

struct Golden {
  Balance balance;
  std::vector<MotionPair> pairs;
  Matrix8d dual_rows, Q, Z;
  Vector8d q;
  Multipliers lambda;
};

Golden read_golden() {
  std::ifstream file(paths::source_dir() + "/tests/lib/golden/six_pairs.txt");
  std::ostringstream numbers;
  for (std::string line; std::getline(file, line);)
    if (!line.starts_with('#')) numbers << line << '\n';
  std::istringstream in(numbers.str());
  const auto vector = [&] {
    Vector8d v;
    for (int i = 0; i < 8; ++i) in >> v[i];
    return v;
  };
  const auto square = [&] {
    Matrix8d M;
    for (int i = 0; i < 8; ++i) M.row(i) = vector().transpose();
    return M;
  };
  Golden golden;
  in >> golden.balance.rotation >> golden.balance.translation;
  for (int i = 0; i < 6; ++i) {
    MotionPair pair;
    pair.a = DualQuaternion::from_vec(vector());
    pair.b = DualQuaternion::from_vec(vector());
    golden.pairs.push_back(pair);
  }
  golden.dual_rows = square();
  golden.Q = square();
  golden.q = vector();
  in >> golden.lambda.norm >> golden.lambda.orthogonal;
  golden.Z = square();
  EXPECT_TRUE(in) << "golden/six_pairs.txt is not complete";
  return golden;
}

TEST(Golden, StatisticsCostMatrixMultipliersAndBound) {
  const Golden golden = read_golden();
  Statistics statistics;
  for (const MotionPair& pair : golden.pairs) statistics.add(pair);
  const double size = golden.dual_rows.trace();
  EXPECT_LT((statistics.dual_rows - golden.dual_rows).cwiseAbs().maxCoeff(), 1e-15 * size);
  const Matrix8d Q = cost_matrix(statistics, golden.balance);
  EXPECT_LT((Q - golden.Q).cwiseAbs().maxCoeff(), 1e-15 * golden.Q.trace());

  const DualQuaternion q = DualQuaternion::from_vec(golden.q);
  const Multipliers lambda = least_squares_multipliers(Q, q);
  EXPECT_NEAR(lambda.norm, golden.lambda.norm, 1e-14);
  EXPECT_NEAR(lambda.orthogonal, golden.lambda.orthogonal, 1e-14);
  EXPECT_LT((lagrangian_matrix(Q, lambda) - golden.Z).cwiseAbs().maxCoeff(), 1e-14);

  const Solution dual = solve_dual(Q);
  EXPECT_EQ(dual.status, SolverStatus::converged);
  EXPECT_LT((dual.q.vec() - canonical_sign(q).vec()).norm(), 1e-12);
  EXPECT_LT((solve_sdp(Q).q.vec() - canonical_sign(q).vec()).norm(), 1e-6);
  const Certificate certificate = verify(Q, dual.q);
  EXPECT_EQ(certificate.optimality, Optimality::certified);
  EXPECT_NEAR(certificate.cost, golden.lambda.norm, 1e-15);
  EXPECT_LE(certificate.lower_bound, golden.lambda.norm);  // the greatest bound there is
  EXPECT_NEAR(certificate.lower_bound, golden.lambda.norm, 1e-14);
  EXPECT_DOUBLE_EQ(certificate.rounding, cost_rounding(Q, dual.q));
}

}  // namespace
}  // namespace egocal::test_golden
