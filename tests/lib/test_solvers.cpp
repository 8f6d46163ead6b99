// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "../support/random_motion.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sqp.hpp"

namespace egocal::test_solvers {
namespace {

using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_extrinsic;
using testing::random_pairs;
using testing::RandomDrive;

Matrix8d cost_of(const DualQuaternion& T, const RandomDrive& drive, Random& random,
                 const Balance& balance = {}) {
  Statistics statistics;
  for (const MotionPair& pair : random_pairs(T, drive, random)) statistics.add(pair);
  return cost_matrix(statistics, balance);
}

TEST(Dual, PerfectDataGiveThePerfectAnswer) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const Matrix8d Q = cost_of(T, {.pairs = 3 + random.below(100), .flip_signs = true}, random);
    const Solution solution = solve_dual(Q);
    EXPECT_EQ(solution.status, SolverStatus::converged);
    const ExtrinsicError error = extrinsic_error(T, solution.q);
    EXPECT_LT(error.rotation, 1e-9) << seed;
    EXPECT_LT(error.translation, 1e-9) << seed;
    EXPECT_EQ(verify(Q, solution.q).optimality, Optimality::certified) << seed;
  }
}

TEST(Dual, NearlyPerfectDataToo) {
  for (const double noise : {1e-13, 1e-11, 1e-9, 1e-8, 1e-7, 1e-6})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Random random(seed);
      const DualQuaternion T = random_extrinsic(random);
      const Matrix8d Q = cost_of(T, {.pairs = 50, .noise = noise}, random);
      const Solution solution = solve_dual(Q);
      const ExtrinsicError error = extrinsic_error(T, solution.q);
      EXPECT_LT(error.rotation, 10 * noise + 1e-9) << noise << " " << seed;
      EXPECT_LT(error.translation, 200 * noise + 1e-9) << noise << " " << seed;
      EXPECT_EQ(verify(Q, solution.q).optimality, Optimality::certified) << noise << " " << seed;
    }
}

TEST(Dual, IsTightWhateverTheNoise) {
  // the theorem (docs/method.md): two constraints, so the relaxation has a rank one solution
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const RandomDrive drive{.motion = static_cast<Motion>(seed % 2),
                            .pairs = 3 + random.below(200),
                            .noise = random.log_uniform(1e-4, 0.5),
                            .flip_signs = true};
    const DualQuaternion T = random_extrinsic(random);
    const Balance balance{1, random.log_uniform(1e-3, 1)};
    const Matrix8d Q = cost_of(T, drive, random, balance);
    const Certificate certificate = verify(Q, solve_dual(Q).q);
    ASSERT_EQ(certificate.optimality, Optimality::certified) << seed;
    ASSERT_LE(certificate.gap, certificate.rounding) << seed;
  }
}

TEST(Dual, NeedsNoStartAndBeatsEveryLocalMinimum) {
  int elsewhere = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const Matrix8d Q = cost_of(T, {.motion = Motion::dominant_axis, .pairs = 3, .noise = 0.3}, random);
    const Solution global = solve_dual(Q);
    for (int i = 0; i < 10; ++i) {
      const Solution local = solve_sqp(Q, random_extrinsic(random));
      const double rounding = 1e-14 * Q.trace() * (1 + local.q.dual.squaredNorm());
      ASSERT_GE(local.cost, global.cost - rounding) << seed;
      if (local.cost > global.cost + rounding) {
        ++elsewhere;
        ASSERT_NE(verify(Q, local.q).optimality, Optimality::certified) << seed;
      }
    }
  }
  EXPECT_GT(elsewhere, 20);  // local minima are real; otherwise this test shows nothing
}

TEST(Dual, AgreesWithSqpToTheLastDigits) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const Matrix8d Q = cost_of(T, {.noise = 0.02}, random);
    const ExtrinsicError difference = extrinsic_error(solve_dual(Q).q, solve_sqp(Q, T).q);
    EXPECT_LT(difference.rotation, 1e-9);
    EXPECT_LT(difference.translation, 1e-9);
  }
}

TEST(Dual, HalfTurnsFarSensorsAndOtherUnits) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const DualQuaternion half_turn = displacement(std::numbers::pi * random.direction(), random.normal3());
    const DualQuaternion far = displacement(random.normal3(), 100 * random.direction());
    for (const DualQuaternion& T : {half_turn, far})
      for (const double unit : {1.0, 1000.0, 1e-3}) {
        Random motion(seed + 1000);
        const DualQuaternion T_unit{T.real, unit * T.dual};
        const Matrix8d Q = cost_of(T_unit, {.pairs = 100, .translation = 0.8 * unit, .noise = 1e-3}, motion,
                                   {1, 1 / (unit * unit)});
        const Solution solution = solve_dual(Q);
        const ExtrinsicError error = extrinsic_error(T_unit, solution.q);
        EXPECT_LT(error.rotation, 0.01);
        EXPECT_LT(error.translation, 0.02 * (unit + T_unit.dual.norm()));
        EXPECT_EQ(verify(Q, solution.q).optimality, Optimality::certified);
      }
  }
}

TEST(Dual, DegenerateMotionNeverGivesNanOrAFalseCertificate) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const RandomDrive drive{.motion = static_cast<Motion>(2 + seed % 3),
                            .pairs = 1 + random.below(4),
                            .noise = seed % 2 == 0 ? 0 : random.log_uniform(1e-9, 0.3)};
    const DualQuaternion T = random_extrinsic(random);
    const Matrix8d Q = cost_of(T, drive, random);
    const Solution solution = solve_dual(Q);
    ASSERT_TRUE(solution.q.vec().allFinite()) << seed;
    ASSERT_NEAR(solution.q.real.norm(), 1, 1e-12);
    const Certificate certificate = verify(Q, solution.q);
    for (int i = 0; i < 10; ++i) {
      const Solution other = solve_sqp(Q, random_extrinsic(random));
      ASSERT_TRUE(other.q.vec().allFinite());
      if (certificate.optimality == Optimality::certified) {
        const double rounding = certificate.rounding + verify(Q, other.q).rounding;
        ASSERT_GE(other.cost, certificate.cost - rounding) << seed;
      }
    }
  }
}

TEST(Solvers, RefuseWhatIsNotFiniteAndSayWhenNothingMoved) {
  Matrix8d Q = Matrix8d::Zero();
  EXPECT_EQ(solve_dual(Q).status, SolverStatus::degenerate);
  EXPECT_EQ(solve_sqp(Q, {}).status, SolverStatus::degenerate);
  EXPECT_EQ(solve_planar(Q).status, SolverStatus::degenerate);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Q = Matrix8d::Identity();
    Q(2, 5) = bad;
    EXPECT_EQ(solve_dual(Q).status, SolverStatus::not_finite);
    EXPECT_EQ(solve_sqp(Q, {}).status, SolverStatus::not_finite);
    EXPECT_EQ(solve_planar(Q).status, SolverStatus::not_finite);
    EXPECT_EQ(verify(Q, {}).optimality, Optimality::undecided);
    EXPECT_EQ(verify_planar(Q, {}).optimality, Optimality::undecided);
  }
}

TEST(Solvers, AreBitIdenticalFromRunToRun) {
  Random random(11);
  const DualQuaternion T = random_extrinsic(random);
  const Matrix8d Q = cost_of(T, {.noise = 0.05}, random);
  const Solution first = solve_dual(Q), first_sqp = solve_sqp(Q, T);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(solve_dual(Q).q.vec(), first.q.vec());
    EXPECT_EQ(solve_sqp(Q, T).q.vec(), first_sqp.q.vec());
  }
}

TEST(Planar, ClosedFormIsTheBestOnTheWholeCircle) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const DualQuaternion T =
        displacement({0, 0, random.uniform(-3, 3)}, {random.normal(), random.normal(), 0});
    const Matrix8d Q = cost_of(T, {.motion = Motion::planar, .noise = random.log_uniform(1e-6, 0.5)}, random);
    const Solution solution = solve_planar(Q);
    EXPECT_NEAR(constraints(solution.q).norm(), 0, 1e-14);
    EXPECT_NEAR(planar_constraints(solution.q).norm(), 0, 1e-14);
    EXPECT_EQ(verify_planar(Q, solution.q).optimality, Optimality::certified) << seed;
    // for every yaw the best translation is a linear problem in q6, q7
    for (int i = 0; i < 360; ++i) {
      const double half = std::numbers::pi * i / 360;
      const Eigen::Vector4d real(std::cos(half), 0, 0, std::sin(half));
      const Eigen::Vector2d xy = -Q.block<2, 2>(5, 5).ldlt().solve(Q.block<4, 2>(0, 5).transpose() * real);
      EXPECT_GE(cost(Q, {real, {0, xy[0], xy[1], 0}}), solution.cost * (1 - 1e-12) - 1e-16);
    }
  }
}

TEST(Planar, PerfectDataGiveThePerfectAnswer) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const DualQuaternion T =
        displacement({0, 0, random.uniform(-3.1, 3.1)}, {random.normal(), random.normal(), 0});
    const Matrix8d Q = cost_of(T, {.motion = Motion::planar, .pairs = 2 + random.below(50)}, random);
    const ExtrinsicError error = extrinsic_error(T, solve_planar(Q).q);
    EXPECT_LT(error.rotation, 1e-9);
    EXPECT_LT(error.translation, 1e-9);
  }
}

TEST(Sqp, AWrongStartMoves) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const Matrix8d Q = cost_of(T, {.noise = 0.01}, random);
    const Solution best = solve_dual(Q);
    for (const double offset : {1e-6, 1e-3, 0.1}) {
      const DualQuaternion start = best.q * testing::random_displacement(random, offset, offset);
      const Solution solution = solve_sqp(Q, start);
      EXPECT_EQ(solution.status, SolverStatus::converged);
      EXPECT_LT(extrinsic_error(best.q, solution.q).rotation, 1e-9) << seed << " " << offset;
      EXPECT_LT(extrinsic_error(best.q, solution.q).translation, 1e-9) << seed << " " << offset;
    }
  }
}

}  // namespace
}  // namespace egocal::test_solvers
