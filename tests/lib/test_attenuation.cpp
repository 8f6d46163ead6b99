// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Errors in variables: what rotation noise takes off a lever arm, and what taking the noise off the cost
// gives back.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/estimation/attenuation.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/solvers/global.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {
namespace {

using testing::Motion;
using testing::Random;
using testing::RandomDrive;

const DualQuaternion T_a_b = testing::displacement({0.3, -0.2, 0.8}, {1.5, -1, 0.8});
const double true_length = to_pose(T_a_b).translation.norm();

Problem problem_of(const std::vector<MotionPair>& pairs) {
  BlockStatistics blocks;
  for (const MotionPair& pair : pairs) blocks.add(pair);
  Problem problem;
  problem.blocks = blocks.inliers();
  return problem;
}

std::vector<MotionPair> pairs_of(double noise, std::uint64_t count, std::uint64_t seed,
                                 Motion motion = Motion::free) {
  Random random(seed);
  RandomDrive drive;
  drive.motion = motion;
  drive.pairs = count;
  drive.noise = noise;
  return random_pairs(T_a_b, drive, random);
}

double length_of(const Problem& problem) {
  return to_pose(solve_dual(cost_matrix(problem)).q).translation.norm() / true_length;
}

double error_of(const DualQuaternion& q) {
  return (to_pose(q).translation - to_pose(T_a_b).translation).norm() / true_length;
}

TEST(Attenuation, TheLengthComesBackAtEveryNoise) {
  for (const double noise : {0.05, 0.1, 0.2, 0.5}) {
    double plain = 0, corrected = 0;
    constexpr int runs = 10;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
      const Problem problem = problem_of(pairs_of(noise, 2000, seed));
      const auto attenuation = whole_attenuation(problem);
      ASSERT_TRUE(attenuation);
      const auto without = without_attenuation(problem, *attenuation);
      ASSERT_TRUE(without);
      plain += length_of(problem) / runs;
      corrected += length_of(*without) / runs;
    }
    // D has the curvature 2 s^2 of turns with a standard deviation s about each axis, and the noise of both
    // sensors adds twice 3/4 of its variance
    const double shorter = 0.75 * noise * noise;
    EXPECT_NEAR(plain, 1 / (1 + shorter), 0.3 * shorter + 0.002) << noise;
    EXPECT_NEAR(corrected, 1, std::max(0.15 * shorter, 0.006)) << noise;
  }
}

TEST(Attenuation, TheCorrectedProblemIsCertifiedAndItsDPositiveSemidefinite) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Problem problem = problem_of(pairs_of(0.02 * static_cast<double>(seed), 60 + 30 * seed, seed));
    const auto attenuation = whole_attenuation(problem);
    if (!attenuation) continue;
    const auto without = without_attenuation(problem, *attenuation);
    if (!without) continue;
    const Matrix8d Q = cost_matrix(*without);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(Q.bottomRightCorner<4, 4>()).eigenvalues()[0],
              0);
    const Answer answer = solve(*without, Method::dual);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << seed;
    // an answer that is off is not certified for it
    const DualQuaternion off = detail::frame_a_moved(answer.T_a_b, detail::Vector6d::Constant(0.01));
    EXPECT_EQ(verify(Q, off).optimality, Optimality::not_optimal) << seed;
  }
}

TEST(Attenuation, NoneWhereThePullIsSmallBesideTheSpread) {
  for (const double noise : {0.0, 0.001, 0.01, 0.02})
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
      EXPECT_FALSE(find_attenuation(problem_of(pairs_of(noise, 300, seed)))) << noise;
}

TEST(Attenuation, NoDirectionThatIsOnlyNoise) {
  for (const double noise : {0.05, 0.2, 0.4})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Problem problem = problem_of(pairs_of(noise, 2000, seed, Motion::planar));
      const auto attenuation = find_attenuation(problem);
      if (!attenuation) continue;
      const auto without = without_attenuation(problem, *attenuation);
      ASSERT_TRUE(without);
      // along the axis that it turns about D is noise alone, and stays what it is
      const auto least = [](const Problem& of) {
        const Eigen::Matrix4d D = cost_matrix(of).bottomRightCorner<4, 4>();
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(D).eigenvalues()[1];
      };
      EXPECT_NEAR(least(*without), least(problem), 0.05 * least(problem)) << noise;
    }
}

/// Motions in a file, weights chosen by the data.
TEST(Attenuation, CalibrateIsNearerToTheTruthAndCoversIt) {
  double plain = 0, ours = 0;
  int covered = 0, directions = 0, corrected = 0;
  constexpr int runs = 12;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const std::vector<MotionPair> pairs = pairs_of(0.4, 1000, 100 + seed);
    CalibrationOptions options;
    options.diagnosis.enabled = false;
    const Calibration found = calibrate(pairs, options);
    options.pairing.balance = Balance{};
    plain += error_of(to_dual_quaternion(calibrate(pairs, options).T_a_b)) / runs;
    ours += error_of(to_dual_quaternion(found.T_a_b)) / runs;
    EXPECT_EQ(found.certificate.optimality, Optimality::certified);
    corrected += found.choice.reason.find("noise taken off") != std::string::npos;
    const auto difference = detail::frame_a_difference(T_a_b, to_dual_quaternion(found.T_a_b));
    for (std::size_t i = 0; i < 3; ++i) {
      if (!found.observability.observable[i]) continue;
      ++directions;
      covered += std::abs(difference[static_cast<Eigen::Index>(i)]) < 1.96 * found.observability.stddev[i];
    }
  }
  EXPECT_GE(corrected, 10);
  EXPECT_LT(ours, 0.6 * plain);
  EXPECT_GE(directions, 2 * runs);
  EXPECT_GE(covered, directions * 85 / 100);
}

/// The same poses one by one and at once, and continued from a saved state.
TEST(Attenuation, OfDrivesIsTheSameBitsHoweverTheyCome) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.relative_noise = 0.2;
  options.poses = 501;
  bool corrected = false;
  for (options.seed = 1; options.seed <= 40 && !corrected; ++options.seed) {
    const testing::Streams streams = testing::simulated_drive(options);
    const MotionPairing whole = paired({}, streams.a, streams.b);
    if (!whole.state().accumulator.attenuation) continue;
    corrected = true;
    MotionPairing first{PairingOptions{}};
    for (std::size_t i = 0; i < streams.a.size(); ++i) {
      if (i == streams.a.size() / 2) first = MotionPairing({}, first.state());
      first.push(Side::a, streams.a[i]);
      first.push(Side::b, streams.b[i]);
    }
    first.finish();
    EXPECT_EQ(whole.state().accumulator.attenuation, first.state().accumulator.attenuation);
    EXPECT_EQ(cost_matrix(whole.problem()), cost_matrix(first.problem()));
    EXPECT_EQ(solve(whole.problem(), Method::dual).certificate.optimality, Optimality::certified);
  }
  EXPECT_TRUE(corrected);
}

}  // namespace
}  // namespace egocal
