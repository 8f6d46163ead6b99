// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/random_motion.hpp"
#include "egocal/baselines/baselines.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_baselines {
namespace {

using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_extrinsic;
using testing::random_pairs;
using testing::RandomDrive;

DualQuaternion near_start(const DualQuaternion& T, Random& random) {
  return T * testing::random_displacement(random, 0.2, 0.5);
}

TEST(Baselines, FindTheTruthWithoutNoise) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const auto pairs = random_pairs(T, {.pairs = 30, .flip_signs = true}, random);
    const BaselineAnswer analytic = solve_analytic(pairs);
    EXPECT_TRUE(analytic.valid) << analytic.note;
    EXPECT_LT(extrinsic_error(T, analytic.T_a_b).rotation, 1e-12) << seed;
    EXPECT_LT(extrinsic_error(T, analytic.T_a_b).translation, 1e-12) << seed;
    const BaselineAnswer matrix = solve_matrix(pairs);
    EXPECT_TRUE(matrix.valid && matrix.certified) << matrix.note;
    // its interior-point method ends at a relative gap of 1e-14; the answer is less exact: 1e-6 on x86-64,
    // 3e-6 on aarch64
    EXPECT_LT(extrinsic_error(T, matrix.T_a_b).rotation, 1e-5) << seed;
    EXPECT_LT(extrinsic_error(T, matrix.T_a_b).translation, 1e-5) << seed;
    const BaselineAnswer local = solve_local(pairs, near_start(T, random));
    EXPECT_TRUE(local.valid) << local.note;
    EXPECT_LT(extrinsic_error(T, local.T_a_b).rotation, 1e-12) << seed;
    EXPECT_LT(extrinsic_error(T, local.T_a_b).translation, 1e-12) << seed;
  }
}

TEST(Baselines, TwoMotionsAreEnough) {
  Random random(11);
  const DualQuaternion T = random_extrinsic(random);
  const auto pairs = random_pairs(T, {.pairs = 2, .rotation = 0.5}, random);
  EXPECT_TRUE(solve_analytic(pairs).valid);
  EXPECT_LT(extrinsic_error(T, solve_analytic(pairs).T_a_b).translation, 1e-12);
  EXPECT_LT(extrinsic_error(T, solve_local(pairs, near_start(T, random)).T_a_b).translation, 1e-9);
  EXPECT_LT(extrinsic_error(T, solve_matrix(pairs).T_a_b).translation, 1e-5);
}

TEST(Baselines, ShrinkTheErrorByAveraging) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const DualQuaternion T = random_extrinsic(random);
    const auto pairs = random_pairs(T, {.pairs = 1000, .noise = 0.01, .flip_signs = true}, random);
    for (const BaselineAnswer& answer :
         {solve_analytic(pairs), solve_matrix(pairs), solve_local(pairs, near_start(T, random))}) {
      EXPECT_TRUE(answer.valid) << answer.note;
      EXPECT_LT(extrinsic_error(T, answer.T_a_b).rotation, 0.003) << seed;
      EXPECT_LT(extrinsic_error(T, answer.T_a_b).translation, 0.03) << seed;
    }
  }
}

TEST(Analytic, FailsOnADriveWithOneDominantAxisAndSaysSo) {
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    RandomDrive drive{.motion = Motion::dominant_axis, .pairs = 300, .noise = 0.05};
    const BaselineAnswer answer = solve_analytic(random_pairs(random_extrinsic(random), drive, random));
    if (!answer.valid) {
      ++refused;
      EXPECT_FALSE(answer.note.empty());
    }
  }
  EXPECT_EQ(refused, 40);
}

TEST(Analytic, NamesTheMissingAxis) {
  for (const Motion motion : {Motion::single_axis, Motion::planar, Motion::translation}) {
    for (const double noise : {0.0, 1e-6, 1e-2}) {
      Random random(4);
      const BaselineAnswer answer =
          solve_analytic(random_pairs(random_extrinsic(random), {.motion = motion, .noise = noise}, random));
      EXPECT_FALSE(answer.valid);
      EXPECT_NE(answer.note.find("axes"), std::string::npos) << answer.note;
    }
  }
}

TEST(Matrix, ItsDualityGapIsClosedAtModerateNoise) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    RandomDrive drive{.motion = Motion::dominant_axis, .pairs = 200, .noise = random.log_uniform(1e-4, 0.1)};
    const BaselineAnswer answer = solve_matrix(random_pairs(random_extrinsic(random), drive, random));
    EXPECT_TRUE(answer.certified) << seed << ' ' << answer.gap;
  }
}

/// The cost of [8] at an extrinsic.
double matrix_cost(const std::vector<MotionPair>& pairs, const DualQuaternion& T_a_b) {
  const Pose T = to_pose(T_a_b);
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  double sum = 0;
  for (const MotionPair& pair : pairs) {
    const Pose a = to_pose(pair.a), b = to_pose(pair.b);
    const Eigen::Matrix3d R_a = a.rotation.toRotationMatrix(), R_b = b.rotation.toRotationMatrix();
    sum += (R_a * R - R * R_b).squaredNorm() +
           (R_a * T.translation + a.translation - R * b.translation - T.translation).squaredNorm();
  }
  return sum;
}

TEST(Matrix, NothingNearbyIsBetter) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const auto pairs = random_pairs(random_extrinsic(random), {.pairs = 50, .noise = 0.2}, random);
    const DualQuaternion T = solve_matrix(pairs).T_a_b;
    const double optimum = matrix_cost(pairs, T);
    for (int i = 0; i < 200; ++i) {
      const double size = random.log_uniform(1e-3, 3);
      const DualQuaternion other = T * testing::random_displacement(random, size, size);
      EXPECT_GE(matrix_cost(pairs, other), optimum * (1 - 1e-12));
    }
  }
}

TEST(Local, NothingNearbyIsBetter) {
  // the sum of squared logarithms of A T B^-1 T^-1
  const auto sum_of_squares = [](const std::vector<MotionPair>& pairs, const DualQuaternion& T) {
    double sum = 0;
    for (const MotionPair& pair : pairs) {
      const Pose loop = to_pose(pair.a * T * conjugate(pair.b) * conjugate(T));
      const Eigen::Vector3d turn = rotation_log(loop.rotation);
      // translation of the logarithm: inverse of the left Jacobian of SO(3)
      const double angle = turn.norm();
      const double k = angle < 1e-6
                           ? 1.0 / 12
                           : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
      const Eigen::Vector3d slide = loop.translation - 0.5 * turn.cross(loop.translation) +
                                    k * turn.cross(turn.cross(loop.translation));
      sum += turn.squaredNorm() + slide.squaredNorm();
    }
    return sum;
  };
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const DualQuaternion truth = random_extrinsic(random);
    const auto pairs = random_pairs(truth, {.pairs = 50, .noise = 0.1}, random);
    const BaselineAnswer answer = solve_local(pairs, truth);
    ASSERT_TRUE(answer.valid) << answer.note;
    const double optimum = sum_of_squares(pairs, answer.T_a_b);
    EXPECT_LT(optimum, sum_of_squares(pairs, truth));
    for (int i = 0; i < 200; ++i) {
      const double size = random.log_uniform(1e-4, 1e-1);
      const DualQuaternion other = answer.T_a_b * testing::random_displacement(random, size, size);
      EXPECT_GT(sum_of_squares(pairs, other), optimum);
    }
  }
}

TEST(Baselines, NeverInventAnAnswerFromNothing) {
  MotionPair bad;
  bad.a.dual[1] = std::nan("");
  for (const std::vector<MotionPair>& pairs :
       {std::vector<MotionPair>{}, std::vector<MotionPair>(3), std::vector<MotionPair>(3, bad)}) {
    for (const BaselineAnswer& answer : {solve_analytic(pairs), solve_matrix(pairs)}) {
      EXPECT_FALSE(answer.valid);
      EXPECT_FALSE(answer.note.empty());
      EXPECT_TRUE(answer.T_a_b.vec().allFinite());
    }
    EXPECT_TRUE(solve_local(pairs).T_a_b.vec().allFinite());
  }
}

}  // namespace
}  // namespace egocal::test_baselines
