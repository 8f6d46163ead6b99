// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What may never be certified, and bounds where the numbers are at their worst: aligned vehicles, singular D,
// motions that show little.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/random_motion.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sqp.hpp"

namespace egocal::test_certificate_edges {
namespace {

using testing::displacement;
using testing::Motion;
using testing::Random;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Matrix8d ordinary_cost(std::uint64_t seed) {
  Random random(seed);
  const DualQuaternion T = testing::random_extrinsic(random);
  return testing::cost_of(testing::random_pairs(T, {.noise = 0.01}, random), {});
}

/// Sensors with parallel axes on a vehicle that turns about z: the entry of Q for height is what is left of
/// numbers that cancel.
Matrix8d aligned_vehicle(std::uint64_t seed, double tilt) {
  Random random(seed);
  const DualQuaternion T = displacement({0, 0, 0.3 * random.normal()}, random.normal3());
  const std::uint64_t pairs = 2 + random.below(30);
  Statistics statistics;
  for (std::uint64_t i = 0; i < pairs; ++i) {
    Eigen::Vector3d turn = random.normal3(tilt), shift = random.normal3(tilt);
    turn.z() = 0.1 * random.normal();
    shift.x() = 1 + 0.1 * random.normal();
    const DualQuaternion a = displacement(turn, shift);
    const Eigen::Vector3d turn_error = random.normal3(1e-3 * tilt), shift_error = random.normal3(tilt);
    statistics.add(a, normalized(conjugate(T) * a * T * displacement(turn_error, shift_error)));
  }
  return cost_matrix(statistics);
}

TEST(CertificateEdges, WhatIsNoExtrinsicIsUndecided) {
  for (const Matrix8d& Q : {ordinary_cost(1), aligned_vehicle(1, 1e-6)}) {
    const DualQuaternion best = solve_dual(Q).q;
    EXPECT_EQ(verify(Q, best).optimality, Optimality::certified);
    const QuaternionVector nothing = QuaternionVector::Constant(nan);
    const DualQuaternion bad[] = {
        {nothing, best.dual},
        {best.real, nothing},
        {QuaternionVector::Zero(), best.dual},
        {QuaternionVector::Zero(), QuaternionVector::Zero()},
        {1e155 * best.real, 1e155 * best.dual},
        {1e-200 * best.real, best.dual},
        {2 * best.real, 2 * best.dual},
        {best.real, best.dual + 0.1 * best.real},
        {best.real, 1e300 * best.dual},
    };
    for (const DualQuaternion& q : bad) {
      EXPECT_EQ(verify(Q, q).optimality, Optimality::undecided) << q.vec().transpose();
      EXPECT_EQ(verify_planar(Q, q).optimality, Optimality::undecided) << q.vec().transpose();
    }
  }
}

TEST(CertificateEdges, APlanarAnswerIsPlanar) {
  Random random(2);
  const DualQuaternion T = testing::random_planar_extrinsic(random, 1);
  const Matrix8d Q = testing::cost_of(testing::random_pairs(T, {.motion = Motion::planar}, random), {});
  const DualQuaternion best = solve_planar(Q).q;
  EXPECT_EQ(verify_planar(Q, best).optimality, Optimality::certified);
  EXPECT_EQ(verify_planar(Q, best * displacement({0.01, 0, 0}, {0, 0, 0})).optimality, Optimality::undecided);
  EXPECT_EQ(verify_planar(Q, best * displacement({0, 0, 0}, {0, 0, 1})).optimality, Optimality::undecided);
}

TEST(CertificateEdges, WhatIsNoCostMatrixIsUndecided) {
  Matrix8d Q = Matrix8d::Identity();
  Q.diagonal() << -1, -2, 3, 4, 1, 1, 1, 1;  // a cost of -2 exists
  EXPECT_EQ(verify(Q, {}).optimality, Optimality::undecided);
  Q.diagonal() << 0, -2, 3, 4, 1, 1, 1, 1;  // so it does here, although this answer costs nothing
  EXPECT_NE(verify(Q, {}).optimality, Optimality::certified);
  Q.diagonal() << 1, 2, 3, 4, 1, -1, 1, 1;  // no least cost at all
  EXPECT_NE(verify(Q, {}).optimality, Optimality::certified);
  EXPECT_NE(solve_dual(Q).status, SolverStatus::converged);

  // the proof reads one triangle, the cost has both
  Q = ordinary_cost(3);
  const DualQuaternion best = solve_dual(Q).q;
  Matrix8d tilted = Q;
  tilted(0, 3) += 0.5;
  EXPECT_EQ(verify(tilted, best).optimality, Optimality::undecided);
  tilted = Q;
  tilted(0, 3) *= 1 + 4 * std::numeric_limits<double>::epsilon();  // rounding of the caller's product
  EXPECT_EQ(verify(tilted, best).optimality, Optimality::certified);
}

TEST(CertificateEdges, NumbersNearUnderflowAreNotTrusted) {
  const Matrix8d Q = ordinary_cost(4);
  const DualQuaternion best = solve_dual(Q).q;
  for (const double scale : {1e-240, 1e-100, 1e100, 1e240})
    EXPECT_EQ(verify(scale * Q, best).optimality, Optimality::certified) << scale;
  for (const double scale : {1e-320, 1e-300, 1e-260, 1e260, 1e305})
    EXPECT_EQ(verify(scale * Q, best).optimality, Optimality::undecided) << scale;
}

TEST(CertificateEdges, AlignedVehiclesHaveNoNegativeCost) {
  // before the sizes of what cancelled were counted, 1 of 260 had a cost below minus its rounding
  int certified = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const double tilt = std::pow(10, -6 - 5 * static_cast<double>(seed % 100) / 100);
    const double height = std::pow(10, static_cast<double>(seed / 100 % 7));
    const Matrix8d Q = aligned_vehicle(seed, tilt);
    const DualQuaternion best = solve_dual(Q).q;
    Pose raised = to_pose(best);
    raised.translation.z() += height;
    for (const DualQuaternion& q : {best, to_dual_quaternion(raised)}) {
      const Certificate certificate = verify(Q, q);
      EXPECT_GE(certificate.cost, -certificate.rounding) << seed;
      EXPECT_LE(certificate.lower_bound, certificate.cost) << seed;
      if (certificate.optimality == Optimality::certified) ++certified;
    }
  }
  EXPECT_GT(certified, 1500);
}

TEST(CertificateEdges, NoCompetitorUndercutsACertifiedAnswerByMoreThanRounding) {
  int certified = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::random_extrinsic(random);
    testing::RandomDrive drive{.motion = static_cast<Motion>(2 + seed % 3)};
    drive.pairs = 1 + random.below(4);
    drive.noise = seed % 2 == 0 ? 0 : random.log_uniform(1e-9, 0.3);
    const Matrix8d Q = testing::cost_of(testing::random_pairs(T, drive, random), {});
    const Certificate certificate = verify(Q, solve_dual(Q).q);
    if (certificate.optimality != Optimality::certified) continue;
    ++certified;
    for (int i = 0; i < 4; ++i) {
      const DualQuaternion other = solve_sqp(Q, testing::random_extrinsic(random)).q;
      EXPECT_GE(cost(Q, other), certificate.lower_bound - certificate.rounding - cost_rounding(Q, other))
          << seed;
    }
  }
  EXPECT_GT(certified, 700);
}

TEST(CertificateEdges, ReachHoldsWhereRotationsHaveNoNoise) {
  // from a worse answer the optimum is within the reach, although D is singular up to rounding. Where the
  // offset is too large for that, the reach is infinite: at these sizes in about 6 of 10 drives.
  int finite = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::random_extrinsic(random);
    Statistics statistics;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d turn = random.normal3(0.1), shift = random.normal3(),
                            error = random.normal3(0.05);
      const DualQuaternion b = displacement(turn, shift);
      statistics.add(T * b * conjugate(T) * displacement({0, 0, 0}, error), b);
    }
    const Matrix8d Q = cost_matrix(statistics);
    const DualQuaternion best = solve_dual(Q).q;
    const double size = random.log_uniform(1e-8, 1e-6);
    const Eigen::Vector3d turn = size * random.direction(), shift = size * random.direction();
    const DualQuaternion worse = best * displacement(turn, shift);
    const Certificate certificate = verify(Q, worse);
    const ExtrinsicError distance = extrinsic_error(worse, best);
    EXPECT_GE(certificate.reach_rotation, distance.rotation) << seed;
    EXPECT_GE(certificate.reach_translation, distance.translation) << seed;
    if (std::isfinite(certificate.reach_translation)) ++finite;
  }
  EXPECT_GT(finite, 50);
}

TEST(CertificateEdges, GarbageStaysVisible) {
  EXPECT_TRUE(normalized({QuaternionVector::Zero(), QuaternionVector::Zero()}).vec().hasNaN());
  EXPECT_TRUE(normalized({QuaternionVector::Constant(nan), QuaternionVector::Zero()}).vec().hasNaN());
  EXPECT_TRUE(to_dual_quaternion({Rotation(nan, 0, 0, 0), {1, 2, 3}}).vec().hasNaN());
  // a local solver that is given such a start takes the identity
  const Matrix8d Q = ordinary_cost(5);
  EXPECT_TRUE(solve_sqp(Q, {QuaternionVector::Zero(), QuaternionVector::Zero()}).q.vec().allFinite());
}

}  // namespace
}  // namespace egocal::test_certificate_edges
