// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Unknown scale: the statistics, the global minimum over scale and extrinsic, what cannot be known.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "../support/paths.hpp"
#include "../support/random_motion.hpp"
#include "../support/real_drives.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/scale/solve_scale.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::test_scale {
namespace {

using testing::Motion;
using testing::Random;
using testing::RandomDrive;

/// Motions of which a's translations are divided by the scale.
std::vector<MotionPair> unscaled_pairs(const DualQuaternion& T, double scale, const RandomDrive& drive,
                                       Random& random) {
  std::vector<MotionPair> pairs = testing::random_pairs(T, drive, random);
  for (MotionPair& pair : pairs) pair.a = scaled(pair.a, 1 / scale);
  return pairs;
}

TEST(ScaleStatistics, AtAScaleIsTheStatisticsOfTheScaledMotions) {
  Random random(1);
  for (const double scale : {0.01, 0.37, 1.0, 8.0, 100.0}) {
    RandomDrive drive;
    drive.noise = 0.05;
    drive.flip_signs = true;
    const std::vector<MotionPair> pairs =
        unscaled_pairs(testing::random_extrinsic(random), scale, drive, random);
    Statistics direct;
    ScaleStatistics first, second;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      direct.add(scaled(pairs[i].a, scale), pairs[i].b, 1 + 0.01 * static_cast<double>(i));
      (i < 40 ? first : second).add(pairs[i].a, pairs[i].b, 1 + 0.01 * static_cast<double>(i));
    }
    first += second;
    const Statistics computed = at_scale(first, scale);
    const double size = direct.dual_rows.diagonal().maxCoeff();
    EXPECT_LT((computed.dual_rows - direct.dual_rows).cwiseAbs().maxCoeff(), 1e-13 * size);
    EXPECT_EQ(computed.count, direct.count);
    EXPECT_NEAR(computed.weight, direct.weight, 1e-12 * direct.weight);
  }
}

TEST(Scale, IsFoundAndCertifiedInTwoHundredDrives) {
  Random random(2);
  const Motion motions[] = {Motion::free, Motion::dominant_axis, Motion::single_axis};
  std::vector<double> errors;
  int certified = 0, observable = 0, covered = 0, most_solves = 0;
  constexpr int drives = 201;
  for (int k = 0; k < drives; ++k) {
    RandomDrive drive;
    drive.motion = motions[k % 3];
    drive.pairs = 400;
    drive.noise = 0.01;
    const double truth = random.log_uniform(0.0101, 99);
    const DualQuaternion T = testing::random_extrinsic(random, 1);
    const auto blocks = scale_blocks(unscaled_pairs(T, truth, drive, random));
    const ScaleSolution solution = solve_scale(blocks);
    errors.push_back(std::abs(solution.scale / truth - 1));
    certified += solution.certified;
    observable += solution.observable;
    covered += std::abs(solution.scale - truth) <= 3 * solution.stddev;
    most_solves = std::max(most_solves, solution.solves);
    EXPECT_LE(solution.least_scale, solution.scale);
    EXPECT_GE(solution.most_scale, solution.scale);
    EXPECT_LT(solution.most_scale / solution.least_scale, 1.01) << k;
  }
  std::sort(errors.begin(), errors.end());
  std::printf("median error %.2e, worst %.2e, solves at most %d, within 3 sigma %d\n", errors[drives / 2],
              errors.back(), most_solves, covered);
  EXPECT_EQ(certified, drives);
  EXPECT_EQ(observable, drives);
  EXPECT_GE(covered, drives - 2);
  EXPECT_LT(errors[drives / 2], 1e-3);
  EXPECT_LE(most_solves, 30);
}

TEST(Scale, PerfectMotionsGiveItToRounding) {
  Random random(3);
  for (const double truth : {0.013, 0.5, 1.0, 77.0}) {
    for (const ScaleNoise noise : {ScaleNoise::both, ScaleNoise::metric, ScaleNoise::unscaled}) {
      const DualQuaternion T = testing::random_extrinsic(random, 1);
      ScaleOptions options;
      options.noise = noise;
      const auto blocks = scale_blocks(unscaled_pairs(T, truth, {}, random));
      const ScaleSolution solution = solve_scale(blocks, options);
      EXPECT_NEAR(solution.scale / truth, 1, 1e-7);
      EXPECT_LT(extrinsic_error(T, solution.q).translation, 1e-6);
      EXPECT_TRUE(solution.certified) << truth << " " << static_cast<int>(noise);
      EXPECT_TRUE(solution.observable);
    }
  }
}

/// The least cost over a fine grid of scales, refined around its best one.
double scanned(const ScaleStatistics& all, const ScaleSolution& solution, const ScaleOptions& options) {
  const auto cost_at = [&](double s) {
    // the weights as the solution has them, extended to other scales
    Balance balance = options.balance;
    const double slope = options.noise == ScaleNoise::metric ? 0
                         : options.noise == ScaleNoise::both ? -1
                                                             : -2;
    balance.translation = solution.balance.translation * std::pow(s / solution.scale, slope);
    const Matrix8d Q = cost_matrix(at_scale(all, s), balance);
    return options.mode == Mode::planar ? solve_planar(Q).cost : solve_dual(Q).cost;
  };
  double best = solution.cost, at = solution.scale;
  for (double log_s = std::log(options.least); log_s < std::log(options.most); log_s += 0.05) {
    const double value = cost_at(std::exp(log_s));
    if (value < best) best = value, at = std::exp(log_s);
  }
  for (double h = 0.02; h > 1e-9; h *= 0.6)
    for (const double s : {std::max(options.least, at * (1 - h)), std::min(options.most, at * (1 + h))}) {
      const double value = cost_at(s);
      if (value < best) best = value, at = s;
    }
  return best;
}

TEST(Scale, NoScanFindsALowerCost) {
  Random random(4);
  const Motion motions[] = {Motion::free, Motion::dominant_axis, Motion::planar, Motion::single_axis};
  for (int k = 0; k < 240; ++k) {
    RandomDrive drive;
    drive.motion = motions[k % 4];
    drive.pairs = 12 + random.below(60);
    drive.noise = random.log_uniform(1e-4, 2);
    ScaleOptions options;
    options.noise = static_cast<ScaleNoise>(k / 4 % 3);
    options.mode = drive.motion == Motion::planar && k % 8 < 4 ? Mode::planar : Mode::spatial;
    options.balance = {1, random.log_uniform(1e-2, 10)};
    const DualQuaternion T = options.mode == Mode::planar ? testing::random_planar_extrinsic(random)
                                                          : testing::random_extrinsic(random);
    const auto blocks = scale_blocks(unscaled_pairs(T, random.log_uniform(0.02, 50), drive, random));
    const ScaleSolution solution = solve_scale(blocks, options);
    const double least = scanned(sum_blocks(blocks), solution, options);
    EXPECT_GE(least, solution.lower_bound - solution.rounding) << k;
    if (solution.certified) {
      EXPECT_LE(solution.cost - least, 1e-9 * std::abs(solution.cost) + 2 * solution.rounding) << k;
    }
  }
}

TEST(Scale, CircleAtConstantSpeedShowsNone) {
  for (const double noise : {0.0, 0.001, 0.01}) {
    Random random(5);
    const DualQuaternion T = testing::displacement({0.1, -0.2, 0.7}, {1, 0.3, -0.2});
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 200; ++i) {
      const DualQuaternion b = testing::displacement({0, 0, 0.1}, {1, 0, 0});
      const auto noisy = [&](const DualQuaternion& q) {
        return q * testing::normal_displacement(random, 0.1 * noise, noise);
      };
      pairs.push_back({noisy(T * b * conjugate(T)), noisy(b)});
    }
    const ScaleSolution solution = solve_scale(scale_blocks(pairs));
    EXPECT_FALSE(solution.observable) << noise;
    EXPECT_LT(solution.observability, 0.01);
    EXPECT_TRUE(std::isinf(solution.stddev));
  }
}

TEST(Scale, TurningOnTheSpotShowsNone) {
  for (const double noise : {0.0, 0.01}) {
    Random random(6);
    // sensor a sits on the axis of rotation: it never moves
    const DualQuaternion T = testing::displacement({0.1, -0.2, 0.7}, {1, 0.3, -0.2});
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 200; ++i) {
      const DualQuaternion a = testing::displacement(random.normal3(0.2), {0, 0, 0});
      const auto noisy = [&](const DualQuaternion& q) {
        return q * testing::normal_displacement(random, 0.1 * noise, noise);
      };
      pairs.push_back({noisy(a), noisy(conjugate(T) * a * T)});
    }
    const ScaleSolution solution = solve_scale(scale_blocks(pairs));
    EXPECT_FALSE(solution.observable) << noise;
    EXPECT_FALSE(noise == 0 && solution.certified);
  }
}

TEST(Scale, NothingOrNonsenseIsNotCertified) {
  EXPECT_FALSE(solve_scale({}).certified);
  ScaleStatistics nan;
  nan.add({{1, 0, 0, 0}, {0, std::nan(""), 0, 0}}, {{1, 0, 0, 0}, {0, 1, 0, 0}});
  const ScaleSolution solution = solve_scale(std::vector{nan});
  EXPECT_FALSE(solution.certified);
  EXPECT_FALSE(solution.observable);
}

/// Nearly one circle: the way is nearly proportional to the turn, so a lever arm explains most of a scale.
std::vector<MotionPair> nearly_a_circle(const DualQuaternion& T, double scale, Random& random) {
  std::vector<MotionPair> pairs;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d turn(0.03 * random.normal(), 0.03 * random.normal(), 0.1 + 0.02 * random.normal());
    const Eigen::Vector3d way(10 * turn[2] * (1 + 0.1 * random.normal()), 0, 0);
    const DualQuaternion a = testing::displacement(turn, way);
    const auto noise = [&] { return testing::displacement(random.normal3(0.001), random.normal3(0.01)); };
    MotionPair pair;
    pair.a = scaled(a * noise(), 1 / scale);
    pair.b = normalized(conjugate(T) * a * T) * noise();
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(Scale, TheExtrinsicsStandardDeviationContainsThatOfTheScale) {
  Random random(12);
  constexpr int drives = 150;
  int without = 0, with = 0, directions = 0;
  for (int k = 0; k < drives; ++k) {
    const DualQuaternion T = testing::random_extrinsic(random, 1);
    const double scale = random.log_uniform(0.1, 10);
    const std::vector<ScaleStatistics> blocks = scale_blocks(nearly_a_circle(T, scale, random));
    ScaleOptions options;
    options.balance = {1, 0.01};
    const ScaleSolution solution = solve_scale(blocks, options);
    ASSERT_TRUE(solution.certified && solution.observable);
    Problem problem;
    problem.balance = solution.balance;
    for (const ScaleStatistics& block : blocks) problem.blocks.push_back(at_scale(block, solution.scale));
    const Answer answer = solve(problem, Method::dual);
    const std::array<double, 6>& fixed = answer.observability.stddev;
    const std::array<double, 6> joint = with_spread_of_scale(answer.observability, problem, solution).stddev;
    const Eigen::Vector3d error = to_pose(answer.T_a_b).translation - to_pose(T).translation;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GE(joint[i], fixed[i]);
      ++directions;
      without += std::abs(error[static_cast<Eigen::Index>(i)]) < 1.96 * fixed[i];
      with += std::abs(error[static_cast<Eigen::Index>(i)]) < 1.96 * joint[i];
    }
  }
  RecordProperty("without", without);
  RecordProperty("with", with);
  EXPECT_LT(without, 0.85 * directions);
  EXPECT_GT(with, 0.92 * directions) << without << " without it";
  EXPECT_LT(with, 0.99 * directions);
}

/// A head that turns about one point: each scale of b has a lever arm of its own.
TEST(Scale, WithoutItTheLeverArmIsNotObservable) {
  Random random(17);
  const DualQuaternion T_a = testing::displacement({0.1, 0.2, 0.3}, {0.1, 0.02, 0}),
                       T_b = testing::displacement({-0.3, 0.2, 0.1}, {0, 0.2, -0.1});
  std::vector<MotionPair> pairs;
  for (int i = 0; i < 400; ++i) {
    const DualQuaternion turn = testing::displacement(random.normal3(0.2), {0, 0, 0});
    const auto noise = [&] { return testing::displacement(random.normal3(1e-4), random.normal3(1e-5)); };
    MotionPair pair;
    pair.a = conjugate(T_a) * turn * T_a * noise();
    pair.b = scaled(conjugate(T_b) * turn * T_b, 0.4) * noise();
    pairs.push_back(pair);
  }
  CalibrationOptions options;
  options.estimate_scale = true;
  options.diagnosis.goal = GoalOptions{};
  const Calibration calibration = calibrate(pairs, options);
  ASSERT_TRUE(calibration.scale && !calibration.scale->observable);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete);
  EXPECT_NE(calibration.reason.find("do not show the scale"), std::string::npos) << calibration.reason;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(calibration.observability.observable[i], i >= 3) << i;
    EXPECT_EQ(std::isinf(calibration.observability.stddev[i]), i < 3) << i;
  }
  ASSERT_TRUE(calibration.goal);
  EXPECT_FALSE(calibration.goal->reached);
}

TEST(Scale, TheSensitivityIsTheSlopeOfTheExtrinsicOverTheScale) {
  Random random(13);
  for (const Mode mode : {Mode::spatial, Mode::planar}) {
    RandomDrive drive;
    drive.noise = 0.02;
    if (mode == Mode::planar) drive.motion = Motion::planar;
    const DualQuaternion T =
        mode == Mode::planar ? testing::random_planar_extrinsic(random) : testing::random_extrinsic(random);
    const std::vector<ScaleStatistics> blocks = scale_blocks(unscaled_pairs(T, 2, drive, random));
    ScaleOptions options;
    options.mode = mode;
    const ScaleSolution solution = solve_scale(blocks, options);
    const auto translation_at = [&](double h) {
      Balance balance = solution.balance;
      balance.translation *= std::exp(-h);
      const Matrix8d Q = cost_matrix(at_scale(sum_blocks(blocks), solution.scale * std::exp(h)), balance);
      return to_pose((mode == Mode::planar ? solve_planar(Q) : solve_dual(Q)).q).translation;
    };
    const Eigen::Vector3d slope = (translation_at(1e-4) - translation_at(-1e-4)) / 2e-4;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(solution.sensitivity[i], slope[static_cast<Eigen::Index>(i)], 0.02 * slope.norm());
  }
}

TEST(Scale, NoiseOnBothSidesIsNotPulledTowardsZero) {
  Random random(7);
  double pulled = 0, balanced = 0, pushed = 0;
  constexpr int drives = 30;
  for (int k = 0; k < drives; ++k) {
    RandomDrive drive;
    drive.pairs = 600;
    drive.noise = 0.1;
    const double truth = random.log_uniform(0.1, 10);
    const auto blocks =
        scale_blocks(unscaled_pairs(testing::random_extrinsic(random, 0.5), truth, drive, random));
    const auto relative = [&](ScaleNoise noise) {
      ScaleOptions options;
      options.noise = noise;
      return solve_scale(blocks, options).scale / truth - 1;
    };
    pulled += relative(ScaleNoise::metric) / drives;
    balanced += relative(ScaleNoise::both) / drives;
    pushed += relative(ScaleNoise::unscaled) / drives;
  }
  std::printf("10 %% noise: metric %.4f, both %.4f, unscaled %.4f\n", pulled, balanced, pushed);
  EXPECT_LT(pulled, -0.005);
  EXPECT_GT(pushed, 0.005);
  EXPECT_LT(std::abs(balanced), 0.003);
}

TEST(Scale, OnTheOtherSensorItIsTheInverse) {
  Random random(8);
  RandomDrive drive;
  drive.noise = 0.02;
  drive.pairs = 200;
  const DualQuaternion T = testing::random_extrinsic(random, 1);
  const auto blocks = scale_blocks(unscaled_pairs(T, 3, drive, random));
  ScaleOptions on_b;
  on_b.side = Side::b;
  const ScaleSolution a = solve_scale(blocks), b = solve_scale(blocks, on_b);
  EXPECT_NEAR(a.scale * b.scale, 1, 2e-3);
  EXPECT_TRUE(b.certified);
  // the extrinsic is in the units of a
  EXPECT_LT((to_pose(b.q).translation - to_pose(T).translation / 3).norm(), 0.1);
}

TEST(Scale, RealCameraScaledDown) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "real drives are not at " << paths::data_dir();
  for (const char* name : {"05", "07"}) {
    testing::Streams streams = testing::kitti(name);
    streams.options.stride = 4;
    streams.options.balance = Balance{1, 0.01};
    const auto pairs = pair_motions(streams.options, streams.b, streams.a).pairs;  // the camera is a
    const auto solve_at = [&](double factor) {
      std::vector<MotionPair> unscaled = pairs;
      for (MotionPair& pair : unscaled) pair.a = scaled(pair.a, factor);
      ScaleOptions options;
      options.balance = *streams.options.balance;
      return solve_scale(scale_blocks(unscaled), options);
    };
    const ScaleSolution full = solve_at(1), scaled_down = solve_at(0.37);
    EXPECT_TRUE(full.certified && scaled_down.certified);
    EXPECT_TRUE(scaled_down.observable);
    EXPECT_NEAR(scaled_down.scale * 0.37, full.scale, 1e-7);
    EXPECT_NEAR(full.scale, 1, 0.02);  // the stereo camera's own scale
    std::printf("kitti %s: scale %.5f +- %.5f (of 1), %d solves, attenuation %.1e\n", name, full.scale,
                full.stddev, full.solves, full.attenuation);
    const ExtrinsicError change = extrinsic_error(full.q, scaled_down.q);
    EXPECT_LT(change.translation, 1e-5);
  }
}

}  // namespace
}  // namespace egocal::test_scale
