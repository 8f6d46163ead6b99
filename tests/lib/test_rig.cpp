// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whole rigs: loops, the sensor to blame, one consistent set with its certificate.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../support/random_rig.hpp"
#include "../support/real_drives.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/rig/rig.hpp"

namespace egocal::test_rig {
namespace {

using testing::Random;
constexpr double degrees = 180 / std::numbers::pi;

using testing::RandomRig;
using testing::RandomRigOptions;

RandomRig random_rig(std::size_t sensors, double noise, Random& random, std::size_t motions = 400,
                     bool road = false) {
  RandomRigOptions options;
  options.sensors = sensors;
  options.noise = noise;
  options.motions = motions;
  options.road = road;
  return testing::random_rig(options, random);
}

TEST(Rig, LoopsCloseAndTheConsistentSetIsCertified) {
  Random random(1);
  int certified = 0, rigs = 0;
  for (std::size_t sensors = 3; sensors <= 6; ++sensors)
    for (int k = 0; k < 6; ++k) {
      ++rigs;
      const RandomRig rig = random_rig(sensors, 0.01, random, 400, k % 2 == 1);
      const RigSolution solution = solve_rig(sensors, rig.pairs);
      certified += solution.set.certified;
      EXPECT_GE(solution.set.cost, solution.set.lower_bound);
      for (const Loop& loop : solution.loops) EXPECT_TRUE(loop.closed) << loop.false_alarm;
      EXPECT_FALSE(solution.blamed);
      for (std::size_t i = 1; i < sensors; ++i) {
        const auto error = extrinsic_error(rig.mounts[i], solution.set.poses[i]);
        EXPECT_LT(error.rotation * degrees, 0.3);
        EXPECT_LT(error.translation, 0.06);
      }
    }
  std::printf("certified %d of %d\n", certified, rigs);
  EXPECT_GE(certified, rigs - 1);
}

TEST(Rig, PerfectMotionsGiveTheMounts) {
  Random random(2);
  const RandomRig rig = random_rig(4, 0, random);
  const RigSolution solution = solve_rig(4, rig.pairs);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_LT(extrinsic_error(rig.mounts[i], solution.set.poses[i]).translation, 1e-6);
  for (const Loop& loop : solution.loops) EXPECT_TRUE(loop.closed);
}

TEST(Rig, ASensorThatSlipsHalfWayIsBlamed) {
  Random random(4);
  int named = 0;
  constexpr int rigs = 6;
  for (int k = 0; k < rigs; ++k) {
    RandomRig rig = random_rig(3, 0.003, random);
    const DualQuaternion slip = testing::displacement(random.direction() * (1 / degrees), {0, 0, 0});
    const std::size_t wrong = static_cast<std::size_t>(k % 3);
    for (RigPair& pair : rig.pairs)
      for (std::size_t i = 200; i < pair.pairs.size(); ++i) {
        if (pair.a == wrong) pair.pairs[i].a = conjugate(slip) * pair.pairs[i].a * slip;
        if (pair.b == wrong) pair.pairs[i].b = conjugate(slip) * pair.pairs[i].b * slip;
      }
    const RigSolution solution = solve_rig(3, rig.pairs);
    const auto loudest = std::max_element(solution.noise.begin(), solution.noise.end());
    named += static_cast<std::size_t>(loudest - solution.noise.begin()) == wrong;
  }
  EXPECT_EQ(named, rigs);
}

TEST(Rig, AnExtrinsicOfOnePairThatContradictsTheOthersOpensTheLoop) {
  Random random(5);
  RandomRig rig = random_rig(3, 0.005, random);
  // what one pair saw is of another mounting, as after a mix-up of recordings
  const DualQuaternion slip = testing::displacement({0, 0, 1 / degrees}, {0, 0, 0});
  for (MotionPair& motion : rig.pairs[2].pairs) motion.b = conjugate(slip) * motion.b * slip;
  const RigSolution solution = solve_rig(3, rig.pairs);
  ASSERT_EQ(solution.loops.size(), 1u);
  EXPECT_FALSE(solution.loops[0].closed);
  EXPECT_NEAR(
      std::hypot(solution.loops[0].misfit[3], solution.loops[0].misfit[4], solution.loops[0].misfit[5]) *
          degrees,
      1, 0.2);
}

TEST(Rig, ALoopWithinWhatItsPairsStateIsNotOpen) {
  Random random(5);
  RandomRig rig = random_rig(3, 0.005, random);
  const DualQuaternion slip = testing::displacement({0, 0, 1 / degrees}, {0, 0, 0});
  for (MotionPair& motion : rig.pairs[2].pairs) motion.b = conjugate(slip) * motion.b * slip;
  const double rotation = 1 / degrees;
  for (RigPair& pair : rig.pairs) pair.stated = {10, 10, 10, rotation, rotation, rotation};
  EXPECT_TRUE(solve_rig(3, rig.pairs).loops.at(0).closed);
  for (RigPair& pair : rig.pairs) pair.stated = {0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4};
  EXPECT_FALSE(solve_rig(3, rig.pairs).loops.at(0).closed);
}

TEST(Rig, ALoopOfAVehicleThatStandsIsUnknown) {
  Random random(7);
  RandomRig rig = random_rig(3, 0.005, random);
  for (RigPair& pair : rig.pairs)
    for (MotionPair& motion : pair.pairs) {
      motion.a = testing::displacement(random.normal3(1e-4), random.normal3(1e-3));
      motion.b = testing::displacement(random.normal3(1e-4), random.normal3(1e-3));
    }
  EXPECT_EQ(solve_rig(3, rig.pairs).loops.at(0).known, 0u);
}

TEST(Rig, TheJointSpreadCoversItsErrors) {
  Random random(8);
  int covered = 0, all = 0;
  for (int k = 0; k < 20; ++k) {
    const RandomRig rig = random_rig(4, 0.01, random);
    const ConsistentSet set = solve_rig(4, rig.pairs).set;
    ASSERT_EQ(set.stddev.size(), 4u);
    for (std::size_t s = 1; s < 4; ++s) {
      const Pose found = to_pose(set.poses[s]), truth = to_pose(rig.mounts[s]);
      const Eigen::Vector3d t = found.translation - truth.translation,
                            r = rotation_log(found.rotation * truth.rotation.conjugate());
      for (std::size_t i = 0; i < 6; ++i) {
        const double error = std::abs(i < 3 ? t[static_cast<int>(i)] : r[static_cast<int>(i) - 3]);
        covered += error <= 1.96 * set.stddev[s][i];
        ++all;
      }
    }
  }
  std::printf("joint spread: %d of %d within 1.96\n", covered, all);
  EXPECT_GE(covered, 0.88 * all);
  EXPECT_LT(covered, all);
}

TEST(Rig, WhatIsMissingIsNamed) {
  Random random(6);
  RandomRig rig = random_rig(3, 0.01, random, 50);
  std::vector<RigPair> pairs = {rig.pairs[0], rig.pairs[2]};  // 0-1, 1-2
  EXPECT_THROW(solve_rig(3, pairs), Error);
  rig.pairs[1].pairs.clear();
  EXPECT_THROW(solve_rig(3, rig.pairs), Error);
}

TEST(Rig, NoMotionCrossesTheGapBetweenTwoDrives) {
  Trajectory sensor;
  for (int i = 0; i < 40; ++i) {
    const std::int64_t time = 100'000 * i + (i < 20 ? 0 : 3'600'000'000);
    const double x = i < 20 ? i : -i;
    sensor.push_back({time, testing::displacement({0, 0, 0.01 * x}, {x, 0, 0})});
  }
  const Trajectory sensors[] = {sensor, sensor};
  RigMotionsOptions options;
  options.stride = 3;
  const std::vector<RigPair> pairs = rig_motions(sensors, options);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].pairs.size(), 2u * 17);
  for (const MotionPair& motion : pairs[0].pairs) EXPECT_EQ(motion.end_us - motion.begin_us, 300'000);
}

TEST(Rig, TangoClosesItsLoop) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "no real drives at " << paths::data_dir();
  const Trajectory sensors[] = {testing::real_trajectory("eth_tango_easy/caligula.tum"),
                                testing::real_trajectory("eth_tango_easy/mars.tum"),
                                testing::real_trajectory("eth_tango_easy/nero.tum")};
  RigMotionsOptions options;
  options.stride = 8;
  options.balance = {1, 0.1};
  const std::vector<RigPair> pairs = rig_motions(sensors, options);
  const RigSolution solution = solve_rig(3, pairs);
  ASSERT_EQ(solution.loops.size(), 1u);
  const auto& misfit = solution.loops[0].misfit;
  std::printf("tango: %.4f deg, %.3f cm, false alarm %.3g, certified %d\n",
              std::hypot(misfit[3], misfit[4], misfit[5]) * degrees,
              100 * std::hypot(misfit[0], misfit[1], misfit[2]), solution.loops[0].false_alarm,
              static_cast<int>(solution.set.certified));
  EXPECT_LT(std::hypot(misfit[3], misfit[4], misfit[5]) * degrees, 0.1);
  EXPECT_LT(std::hypot(misfit[0], misfit[1], misfit[2]), 0.02);
}

}  // namespace
}  // namespace egocal::test_rig
