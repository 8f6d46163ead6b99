// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "../support/random_motion.hpp"
#include "certificate/proof.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::test_certificate {
namespace {

using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_pairs;
using testing::RandomDrive;

Matrix8d cost_of(const DualQuaternion& T, const RandomDrive& drive, Random& random) {
  Statistics statistics;
  for (const MotionPair& pair : random_pairs(T, drive, random)) statistics.add(pair);
  return cost_matrix(statistics);
}

long double extended_cost(const Matrix8d& Q, const DualQuaternion& q) {
  const Eigen::Matrix<long double, 8, 1> v = q.vec().cast<long double>();
  return v.dot(Q.cast<long double>() * v);
}

TEST(Proof, AcceptsSemidefiniteAndRefusesIndefiniteMatrices) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix4d R = Eigen::Matrix4d::NullaryExpr([&] { return random.normal(); });
    const Eigen::Matrix4d definite = R * R.transpose();
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(definite, Eigen::EigenvaluesOnly).eigenvalues()[0];
    EXPECT_TRUE(detail::proven_bound<4>(definite, 0, 0, 0));
    std::array<std::array<detail::Extended, 4>, 4> indefinite;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        indefinite[a][b] =
            definite(static_cast<int>(a), static_cast<int>(b)) - (a == b ? least * (1 + 1e-6) + 1e-14 : 0);
    EXPECT_FALSE(detail::proven_semidefinite<4>(indefinite));
  }
}

TEST(Certificate, BoundHoldsForEveryOtherExtrinsic) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::normal_displacement(random, 1, 2);
    const Matrix8d Q =
        cost_of(T, {.motion = static_cast<Motion>(seed % 2), .noise = random.log_uniform(1e-5, 0.3)}, random);
    const Certificate certificate = verify(Q, solve_dual(Q).q);
    for (int i = 0; i < 50; ++i) {
      const double reach = random.log_uniform(1e-6, 10);
      const DualQuaternion other = T * testing::normal_displacement(random, reach, reach);
      EXPECT_GE(static_cast<double>(extended_cost(Q, other)), certificate.lower_bound) << seed;
    }
  }
}

TEST(Certificate, NoPerturbedAnswerPasses) {
  // along random directions and along the flattest ones, from 0.001 to 20 deg and 0.1 mm to 20 m
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::normal_displacement(random, 1, 2);
    const Matrix8d Q =
        cost_of(T, {.motion = static_cast<Motion>(seed % 4), .noise = random.log_uniform(1e-6, 0.3)}, random);
    const Solution best = solve_dual(Q);
    const long double least = extended_cost(Q, best.q);
    const double rounding_best = verify(Q, best.q).rounding;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> D(Q.bottomRightCorner<4, 4>());
    for (int i = 0; i < 40; ++i) {
      const double angle = random.log_uniform(1e-3, 20) * std::numbers::pi / 180;
      const double shift = random.log_uniform(1e-4, 20);
      DualQuaternion other =
          best.q *
          displacement(i % 4 == 1 ? Eigen::Vector3d::Zero().eval() : (angle * random.direction()).eval(),
                       i % 4 == 2 ? Eigen::Vector3d::Zero().eval() : (shift * random.direction()).eval());
      if (i % 4 == 3)
        other = normalized({best.q.real, best.q.dual + 0.5 * shift * D.eigenvectors().col(1 + i % 3)});
      const Certificate certificate = verify(Q, other);
      const bool worse = extended_cost(Q, other) > least + certificate.rounding + rounding_best;
      if (certificate.optimality == Optimality::certified) {
        EXPECT_FALSE(worse) << seed << " " << i;
      } else {
        ++refused;
        EXPECT_TRUE(!worse || certificate.optimality == Optimality::not_optimal) << seed << " " << i;
      }
    }
  }
  EXPECT_GT(refused, 6000);
}

TEST(Certificate, PlanarPerturbationsDoNotPassEither) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T =
        displacement({0, 0, random.uniform(-3, 3)}, {random.normal(), random.normal(), 0});
    const Matrix8d Q = cost_of(T, {.motion = Motion::planar, .noise = random.log_uniform(1e-6, 0.3)}, random);
    const DualQuaternion best = solve_planar(Q).q;
    for (int i = 0; i < 20; ++i) {
      const DualQuaternion other =
          best * displacement({0, 0, random.log_uniform(1e-5, 0.3)}, {random.log_uniform(1e-4, 20), 0, 0});
      const Certificate certificate = verify_planar(Q, other);
      if (certificate.optimality == Optimality::certified) {
        EXPECT_LE(certificate.cost, cost(Q, best) + 2 * certificate.rounding);
      } else {
        EXPECT_EQ(certificate.optimality, Optimality::not_optimal);
      }
    }
  }
}

TEST(Certificate, ReachContainsTheOptimum) {
  // from an answer that is off, the optimum lies within the reach that its gap allows
  int finite = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::normal_displacement(random, 1, 2);
    const Matrix8d Q = cost_of(T, {.motion = static_cast<Motion>(seed % 2), .noise = 1e-3}, random);
    const DualQuaternion best = solve_dual(Q).q;
    const double size = random.log_uniform(1e-7, 1e-3);
    const DualQuaternion off = best * testing::random_displacement(random, size, size);
    const Certificate certificate = verify(Q, off);
    const ExtrinsicError distance = extrinsic_error(off, best);
    EXPECT_GE(certificate.reach_rotation, distance.rotation) << seed;
    EXPECT_GE(certificate.reach_translation, distance.translation) << seed;
    if (std::isfinite(certificate.reach_translation)) ++finite;
  }
  EXPECT_GT(finite, 200);
}

TEST(Certificate, ReachSeesFlatDirections) {
  // height is nearly free on a drive with one dominant axis: the same gap reaches much farther there
  Random random(3), other(3);
  const DualQuaternion T = displacement({0.1, 0.2, 0.3}, {1, 2, 3});
  const Matrix8d drive = cost_of(T, {.motion = Motion::dominant_axis, .noise = 1e-4}, random);
  const Matrix8d free = cost_of(T, {.motion = Motion::free, .noise = 1e-4}, other);
  const Certificate along = verify(drive, solve_dual(drive).q), across = verify(free, solve_dual(free).q);
  EXPECT_EQ(along.optimality, Optimality::certified);
  EXPECT_EQ(across.optimality, Optimality::certified);
  EXPECT_GT(along.reach_translation, 5 * across.reach_translation);
  EXPECT_LT(along.reach_translation, 1e-3);
}

TEST(Certificate, UnobservableDirectionsHaveInfiniteReach) {
  Random random(4);
  const DualQuaternion T = displacement({0.1, 0.2, 0.3}, {1, 2, 3});
  const Matrix8d Q = cost_of(T, {.motion = Motion::planar}, random);
  EXPECT_TRUE(std::isinf(verify(Q, T).reach_translation));
}

TEST(Certificate, RotationWithoutNoiseAndTranslationWithIsDecided) {
  // D is singular up to rounding although the cost is not small: the case that the lift is for
  int certified = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::normal_displacement(random);
    Statistics statistics;
    for (int i = 0; i < 100; ++i) {
      const DualQuaternion b = testing::normal_displacement(random, 0.1, 1);
      statistics.add(T * b * conjugate(T) * displacement({0, 0, 0}, random.normal3(0.05)), b);
    }
    const Matrix8d Q = cost_matrix(statistics);
    const Certificate certificate = verify(Q, solve_dual(Q).q);
    EXPECT_GT(certificate.cost, 1e-4);
    if (certificate.optimality == Optimality::certified) ++certified;
  }
  EXPECT_EQ(certified, 100);
}

TEST(Certificate, GapGrowsWithTheErrorWhateverTheNumberOfFrames) {
  // section V-F
  for (const std::uint64_t pairs : {50u, 500u, 5000u}) {
    Random random(5);
    const DualQuaternion T = displacement({0.1, 0.2, 0.3}, {1, 2, 3});
    const Matrix8d Q = cost_of(T, {.pairs = pairs, .noise = 0.02}, random);
    const DualQuaternion best = solve_dual(Q).q;
    double last = 0;
    for (const double degrees : {0.001, 0.01, 0.1, 1.0, 10.0}) {
      const double gap =
          verify(Q, best * displacement({0, 0, degrees * std::numbers::pi / 180}, {0, 0, 0})).gap;
      EXPECT_GT(gap, 30 * last);
      last = gap;
    }
    EXPECT_NEAR(last, 0.02, 0.015);  // of the same size for any number of pairs
  }
}

}  // namespace
}  // namespace egocal::test_certificate
