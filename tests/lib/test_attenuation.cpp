// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Errors in variables: what rotation noise takes off a lever arm, and what taking the noise off the cost
// gives back.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/estimation/attenuation.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/solvers/global.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_attenuation {
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

/// Circles of 10 m at 0.8 m a motion, turned by `variation` more and less; the noise of b's motions, a part
/// of them, is spread over each.
std::vector<MotionPair> circle_pairs(const DualQuaternion& T, double variation, double noise,
                                     std::uint64_t count, std::uint64_t seed) {
  Random random(seed);
  constexpr double length = 0.8, turn = 0.08;
  const double phase = random.uniform(0, 6);
  std::vector<MotionPair> pairs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double turned = turn * (1 + variation * std::sin(0.03 * static_cast<double>(i) + phase));
    const DualQuaternion a = testing::displacement({0, 0, turned}, {length, 0, 0});
    const Eigen::Vector3d half(0, 0, 0.5 * noise * turn * random.normal());
    const double x = noise * length * random.normal(), y = noise * length * random.normal();
    const DualQuaternion b = conjugate(T) * a * T;
    pairs.push_back({a, testing::displacement(half, Eigen::Vector3d::Zero()) * b *
                            testing::displacement(half, {x, y, 0})});
  }
  return pairs;
}

Problem planar_problem_of(const std::vector<MotionPair>& pairs) {
  Problem problem = problem_of(pairs);
  problem.mode = Mode::planar;
  return problem;
}

/// Of planar problems in sensor a's frame, whose planes are those of the sensors.
const DualQuaternion T_in_plane = testing::displacement({0, 0, 0.5}, {1.5, -1, 0});

/// Noise of the rotations is what tells the yaw along a circle whose radius hardly changes.
TEST(Attenuation, PlanarYawOfNearlyCircularDriving) {
  double plain = 0, ours = 0;
  int corrected = 0, covered = 0, covered_before = 0, directions = 0;
  constexpr int runs = 60;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const Problem problem = planar_problem_of(circle_pairs(T_in_plane, 0.1, 0.05, 1000, seed));
    const auto attenuation = find_attenuation(problem);
    const Answer before = solve(problem, Method::dual);
    Answer answer = before;
    if (attenuation) {
      const auto without = without_attenuation(problem, *attenuation);
      ASSERT_TRUE(without);
      answer = solve(*without, Method::dual);
      EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << seed;
      ++corrected;
    }
    const auto error_before = detail::frame_a_difference(T_in_plane, before.T_a_b);
    const auto error = detail::frame_a_difference(T_in_plane, answer.T_a_b);
    plain += error_before[5] / runs;
    ours += error[5] / runs;
    for (const std::size_t i : {0u, 1u, 5u}) {
      const auto k = static_cast<Eigen::Index>(i);
      if (!answer.observability.observable[i]) continue;
      ++directions;
      covered += std::abs(error[k]) < 1.96 * answer.observability.stddev[i];
      covered_before += std::abs(error_before[k]) < 1.96 * before.observability.stddev[i];
    }
  }
  std::printf("yaw off by %.2f, corrected by %.2f deg in the mean; %d corrected; covered %d, %d of %d\n",
              57.3 * plain, 57.3 * ours, corrected, covered_before, covered, directions);
  EXPECT_GE(corrected, runs / 2);
  EXPECT_LT(std::abs(ours), 0.5 * std::abs(plain));
  EXPECT_GE(directions, runs * 3 * 9 / 10);
  EXPECT_GE(covered, directions * 90 / 100);
}

/// In three dimensions, tilted by 10 mrad. The pull on the yaw is corrected where the standard deviation
/// allows it, and a part of that elsewhere.
TEST(Attenuation, SpatialYawOfNearlyCircularDriving) {
  int covered = 0, directions = 0, corrected = 0, still_covered = 0;
  double plain = 0, ours = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    constexpr double length = 0.8, turn = 0.08, noise = 0.05;
    const double phase = random.uniform(0, 6);
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 1000; ++i) {
      const double t = 0.1 * i;
      const Eigen::Vector3d rotation(0.01 * std::sin(0.7 * t + phase), 0.01 * std::sin(0.9 * t),
                                     turn * (1 + 0.1 * std::sin(0.3 * t + phase)));
      const DualQuaternion a = testing::displacement(rotation, {length, 0, 0});
      const DualQuaternion noise_of_b =
          testing::displacement(random.normal3(noise * turn), random.normal3(noise * length));
      pairs.push_back({a, conjugate(T_in_plane) * a * T_in_plane * noise_of_b});
    }
    const Answer answer = solve(problem_of(pairs), Method::dual);
    const double error = detail::frame_a_difference(T_in_plane, answer.T_a_b)[5];
    if (!answer.observability.observable[5]) continue;
    ++directions;
    covered += std::abs(error) < 1.96 * answer.observability.stddev[5];
    const auto attenuation = find_attenuation(problem_of(pairs));
    if (!attenuation) continue;
    const auto without = without_attenuation(problem_of(pairs), *attenuation);
    ASSERT_TRUE(without);
    const Answer better = solve(*without, Method::dual);
    const double error_left = detail::frame_a_difference(T_in_plane, better.T_a_b)[5];
    EXPECT_EQ(better.certificate.optimality, Optimality::certified) << seed;
    ++corrected;
    still_covered += std::abs(error_left) < 1.96 * better.observability.stddev[5];
    plain += error * error;
    ours += error_left * error_left;
  }
  std::printf(
      "yaw within 1.96 standard deviations in %d of %d; corrected %d, error %.2f times, within in %d\n",
      covered, directions, corrected, std::sqrt(ours / plain), still_covered);
  EXPECT_GE(directions, 50);
  EXPECT_GE(covered, directions * 80 / 100);
  EXPECT_GE(corrected, 25);
  EXPECT_LT(ours, 0.8 * plain);
  EXPECT_GE(still_covered, corrected * 85 / 100);
}

TEST(Attenuation, NoneInThePlaneWhereCurvesDiffer) {
  for (const double noise : {0.0, 0.01, 0.05})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto pairs = circle_pairs(T_in_plane, 1, noise, 300, seed);
      EXPECT_FALSE(find_attenuation(planar_problem_of(pairs))) << noise;
    }
}

/// Straight on, as in a corridor: nothing but the noise of b's rotations seems to show x and y.
TEST(Attenuation, NoiseThatShowsNoTranslationPullsNoYaw) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 1000; ++i) {
      const DualQuaternion a = testing::displacement({0, 0, 1e-4 * random.normal()}, {1, 0, 0});
      const DualQuaternion b = conjugate(T_in_plane) * a * T_in_plane;
      pairs.push_back({a, b * testing::displacement({0, 0, 0.01 * random.normal()}, {0, 0, 0})});
    }
    const Answer answer = solve(planar_problem_of(pairs), Method::dual);
    ASSERT_TRUE(answer.observability.observable[5]) << seed;
    EXPECT_LT(answer.observability.stddev[5], 0.002) << seed;
  }
}

/// Along circles of one radius nothing shows the yaw but noise, however exact it seems to be.
TEST(Attenuation, NoYawAlongCirclesOfOneRadius) {
  for (const double noise : {0.001, 0.01, 0.05})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Answer answer =
          solve(planar_problem_of(circle_pairs(T_in_plane, 0, noise, 1000, seed)), Method::dual);
      EXPECT_FALSE(answer.observability.observable[5]) << noise;
      EXPECT_FALSE(answer.observability.observable[0]) << noise;
      EXPECT_EQ(answer.observability.hint, "still needed: curves of other radii, or a straight stretch");
    }
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

TEST(Attenuation, OfPlanarDrivesIsTheSameBitsHoweverTheyCome) {
  PairingOptions options;
  options.mode = Mode::planar;
  bool corrected = false;
  for (std::uint64_t seed = 1; seed <= 20 && !corrected; ++seed) {
    std::array<Trajectory, 2> streams{Trajectory{{0, {}}}, Trajectory{{0, {}}}};
    for (const MotionPair& pair : circle_pairs(T_in_plane, 0.1, 0.05, 1000, seed)) {
      const std::int64_t time_us = streams[0].back().time_us + 100'000;
      streams[0].push_back({time_us, streams[0].back().pose * pair.a});
      streams[1].push_back({time_us, streams[1].back().pose * pair.b});
    }
    const MotionPairing whole = paired(options, streams[0], streams[1]);
    if (!whole.state().accumulator.attenuation) continue;
    corrected = true;
    MotionPairing first{options};
    for (std::size_t i = 0; i < streams[0].size(); ++i) {
      if (i == streams[0].size() / 2) first = MotionPairing(options, first.state());
      first.push(Side::a, streams[0][i]);
      first.push(Side::b, streams[1][i]);
    }
    first.finish();
    EXPECT_EQ(whole.state().accumulator.attenuation, first.state().accumulator.attenuation);
    EXPECT_EQ(cost_matrix(whole.problem()), cost_matrix(first.problem()));
    EXPECT_EQ(solve(whole.problem(), Method::dual).certificate.optimality, Optimality::certified);
    EXPECT_NE(whole.choice().reason.find("rotation noise taken off"), std::string::npos);
  }
  EXPECT_TRUE(corrected);
}

}  // namespace
}  // namespace egocal::test_attenuation
