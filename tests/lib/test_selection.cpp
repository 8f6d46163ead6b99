// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The choice between motions of several strides.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "../support/random_motion.hpp"
#include "../support/shaken_car.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal::test_selection {
namespace {

using testing::displacement;
using testing::Motion;
using testing::Random;
using testing::random_extrinsic;
using testing::random_pairs;
using testing::random_planar_extrinsic;

std::vector<Statistics> blocks_of(const DualQuaternion& T, std::size_t pairs, double noise,
                                  std::uint64_t seed) {
  Random random(seed);
  BlockStatistics blocks;
  for (const MotionPair& pair : random_pairs(T, {.pairs = pairs, .noise = noise}, random)) blocks.add(pair);
  return blocks.inliers();
}

/// Which of three strides is chosen where steps are precise but see another extrinsic.
int chosen_stride(const Eigen::Vector3d& error_of_steps, std::uint64_t seed) {
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  const DualQuaternion of_steps = displacement({0, 0, 0}, error_of_steps) * T;
  const std::vector<Candidate> candidates = {{1, {1, 1}, blocks_of(of_steps, 1200, 0.002, 3 * seed)},
                                             {2, {1, 1}, blocks_of(T, 600, 0.01, 3 * seed + 1)},
                                             {4, {1, 1}, blocks_of(T, 300, 0.02, 3 * seed + 2)}};
  const std::optional<Selection> selection = select_candidate({}, candidates, std::nullopt);
  return selection ? candidates[selection->index].stride : 0;
}

TEST(Selection, PreciseStepsAreTakenWhereLongerMotionsAgree) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_EQ(chosen_stride({0, 0, 0}, seed), 1) << seed;
}

TEST(Selection, StepsThatLongerMotionsContradictAreRefused) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_GT(chosen_stride({0, 0, 0.06}, seed), 1) << seed;
}

/// An aircraft at 100 m/s in banked turns, four minutes at 10 Hz; noise of 0.5 deg and 7 m in each second.
testing::Streams aircraft(std::uint64_t seed) {
  constexpr double period = 0.1, speed = 100, gravity = 9.81;
  Random random(seed);
  const testing::Shaking bank(random, 0.005, 0.02, 0.2), climb(random, 0.01, 0.05, 0.02);
  const std::array<DualQuaternion, 2> mounts{testing::random_displacement(random, 3, 2),
                                             testing::random_displacement(random, 3, 2)};
  testing::Streams streams;
  streams.T = conjugate(mounts[0]) * mounts[1];
  std::array<DualQuaternion, 2> poses;
  DualQuaternion before;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw = 0;
  for (int i = 0; i <= 2400; ++i) {
    const double t = i * period, roll = bank.at(t), pitch = climb.at(t);
    yaw += period * gravity * std::tan(roll) / speed;
    const Rotation rotation =
        rotation_exp({0, 0, yaw}) * rotation_exp({0, pitch, 0}) * rotation_exp({roll, 0, 0});
    position += rotation * Eigen::Vector3d(speed * period, 0, 0);
    const DualQuaternion body = to_dual_quaternion(Pose{rotation, position}),
                         motion = conjugate(before) * body;
    before = body;
    for (std::size_t k = 0; k < 2; ++k) {
      const DualQuaternion noise =
          displacement(random.normal3(0.008 * std::sqrt(period)), random.normal3(7 * std::sqrt(period)));
      if (i > 0)
        poses[k] = canonical_sign(normalized(poses[k] * (conjugate(mounts[k]) * motion * mounts[k]) * noise));
      (k == 0 ? streams.a : streams.b).push_back({static_cast<std::int64_t>(i) * 100'000, poses[k]});
    }
  }
  return streams;
}

/// The translations of a fast machine are known to metres only and say nothing about the rotation about the
/// direction of travel: a lever arm of half the length of a motion has the same effect as half a turn. The
/// rotations show it, if they count.
TEST(Selection, TranslationsOfAFastMachineCountAsLittleAsTheyAreKnown) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const testing::Streams streams = aircraft(seed);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b)).rotation, 0.1) << seed;
    EXPECT_LT(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
  }
}

TEST(Selection, SmallerBalancesAreTriedWhereTranslationsWeighFarMore) {
  Random random(3);
  const std::array<double, 2> balances{0.001, 0.1};
  const auto selected = [&](double metres, Mode mode, const std::optional<Balance>& fixed) {
    const bool planar = mode == Mode::planar;
    const DualQuaternion T = planar ? random_planar_extrinsic(random) : random_extrinsic(random);
    BlockStatistics blocks;
    for (MotionPair pair :
         random_pairs(T, {.motion = planar ? Motion::planar : Motion::free, .pairs = 1200}, random)) {
      Eigen::Vector3d turn = random.normal3(0.01), shift = random.normal3(metres);
      if (planar) turn.head<2>().setZero(), shift[2] = 0;
      pair.b = canonical_sign(pair.b * displacement(turn, shift));
      blocks.add(pair);
    }
    Problem problem;
    problem.mode = mode;
    const MotionsOfStride motions{1, blocks.inliers()};
    return select_setting(problem, {&motions, 1}, balances, fixed, std::nullopt).value();
  };
  EXPECT_EQ(selected(0.1, Mode::spatial, std::nullopt).tried, 2);
  // residuals of 0.01 rad and 10 m balance at 1e-6: 1e-4, 1e-5 and so on to a tenth of that
  const SelectedSetting fast = selected(10, Mode::spatial, std::nullopt);
  EXPECT_GE(fast.tried, 2 + 3);
  EXPECT_LE(fast.tried, 2 + 4);
  EXPECT_LT(fast.setting.balance.translation, 0.001);
  EXPECT_EQ(selected(10, Mode::planar, std::nullopt).tried, 2);
  const SelectedSetting fixed = selected(10, Mode::spatial, Balance{1, 0.5});
  EXPECT_EQ(fixed.tried, 1);
  EXPECT_EQ(fixed.setting.balance.translation, 0.5);
}

/// Slow, on an uneven road, with noise of a tenth of the mean motion, given as motions alone. The rotation
/// error [deg].
double error_of_motions(std::uint64_t seed, int poses) {
  SimulationOptions options;
  options.speed = 1;
  options.poses = poses;
  options.speed_variation = 0.5;
  options.relative_noise = 0.1;
  options.noise_of_motion = 0.05;
  options.seed = seed;
  const testing::Streams streams = testing::simulated_drive(options);
  std::vector<MotionPair> motions;
  for (std::size_t i = 1; i < streams.a.size(); ++i)
    motions.push_back({normalized(conjugate(streams.a[i - 1].pose) * streams.a[i].pose),
                       normalized(conjugate(streams.b[i - 1].pose) * streams.b[i].pose)});
  const Calibration calibration = calibrate(motions);
  constexpr double degrees = 57.29577951308232;
  return extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b)).rotation * degrees;
}

/// Translations with a thousand times too much weight have their least cost at a wrong minimum with a small
/// spread, or show no direction at all. The residuals of the other balances reveal it. (Two of these drives
/// were off by 154 and 157 deg, one by 39.)
TEST(Selection, MotionsWithoutPosesAreNotTurnedByABalanceThatTheResidualsRefute) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) EXPECT_LT(error_of_motions(seed, 101), 35) << seed;
}

}  // namespace
}  // namespace egocal::test_selection
