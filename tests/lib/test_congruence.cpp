// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/congruence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "../support/random_motion.hpp"
#include "../support/real_drives.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_congruence {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});

/// Small motions, of which a part is damaged by up to tens of times their size.
TEST(Congruence, PairsInAnyOrderAreJudgedByTheirLike) {
  for (const std::uint64_t count : {100u, 1500u, 2500u})
    for (const double part : {0.0, 0.05, 0.2, 0.3})
      for (const double size : {0.5, 2.0}) {
        Random random(count);
        auto pairs = random_pairs(
            T_a_b, {.pairs = count, .rotation = 0.05, .translation = 0.3, .noise = 0.01}, random);
        std::vector<bool> spoilt;
        for (MotionPair& pair : pairs) {
          spoilt.push_back(random.uniform() < part);
          if (spoilt.back())
            pair.b = canonical_sign(normalized(pair.b * testing::normal_displacement(random, size, size)));
        }
        const std::vector<bool> found = incongruent(pairs);
        ASSERT_EQ(found.size(), count);
        int missed = 0, wronged = 0;
        for (std::size_t i = 0; i < count; ++i) {
          missed += spoilt[i] && !found[i];
          wronged += !spoilt[i] && found[i];
        }
        EXPECT_LE(missed, 0.05 * part * static_cast<double>(count)) << count << " " << part << " " << size;
        EXPECT_EQ(wronged, 0) << count << " " << part << " " << size;
      }
}

TEST(Congruence, TooFewToTellAreNotJudged) {
  Random random(1);
  auto pairs = random_pairs(T_a_b, {.pairs = 10, .noise = 0.01}, random);
  pairs[3].b = displacement({1, 1, 1}, {3, 0, 0});
  const std::vector<bool> found = incongruent(pairs);
  EXPECT_EQ(std::count(found.begin(), found.end(), true), 0);
  EXPECT_TRUE(incongruent({}).empty());
}

/// Straight for a while, then around on the spot. The straight part shows nothing of a lever arm across it,
/// and noise that grows with turning hardly shows there.
TEST(Congruence, FirstTurnInPlaceIsNotRejected) {
  for (const bool grows : {false, true})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(seed);
      const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {-1.5, 2, 0.3});
      Trajectory a, b;
      DualQuaternion at_a, at_b = T;
      for (int i = 0; i < 100; ++i) {
        a.push_back({100000LL * i, at_a});
        b.push_back({100000LL * i, at_b});
        const bool turns = i / 30 % 2 == 1;
        const DualQuaternion step =
            displacement({0.005 * std::sin(0.2 * i), 0.005 * std::sin(0.17 * i), turns ? 0.08 : 0},
                         {turns ? 0 : 0.1, 0, 0});
        const double noise = grows && !turns ? 1e-4 : 3e-4;
        at_a = normalized(at_a * step * testing::normal_displacement(random, noise, 1e-3));
        at_b = normalized(at_b * conjugate(T) * step * T * testing::normal_displacement(random, noise, 1e-3));
      }
      const PairingCounts counts = pair_motions({}, a, b).drive.counts();
      for (const std::uint64_t rejected : counts.rejected) EXPECT_EQ(rejected, 0u) << grows << " " << seed;
    }
}

/// The basis of ScreeningOptions::doubtful and CongruenceOptions::most_growing: real odometry has heavy
/// tails, but a step of it is hardly ever as far from congruent as a wrong pose.
TEST(RealCongruence, StepsOfRealDrivesAreHardlyEverDoubtful) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "shared/data is not there";
  const std::pair<const char*, testing::Streams> drives[] = {{"KITTI 05", testing::kitti("05")},
                                                             {"KITTI 07", testing::kitti("07")},
                                                             {"EuRoC", testing::euroc()},
                                                             {"arm", testing::robot_arm()}};
  const ScreeningOptions limits;
  for (const auto& [name, streams] : drives) {
    PairingOptions options;
    options.stride = 1;
    options.balance = Balance{};
    options.robust = false;
    CongruenceScale scale;
    int steps = 0, doubtful = 0;
    double largest = 0, growing = 0;
    for (const MotionPair& step : pair_motions(options, streams.a, streams.b).pairs) {
      const MotionDifference difference = difference_of(step.a, step.b, limits.congruence);
      const double distance = incongruence(difference, 1, scale, limits.congruence);
      ++steps;
      doubtful += distance > limits.doubtful;
      largest = std::max(largest, distance);
      growing = std::max({growing, scale.angle.growing, scale.length.growing});
      update_congruence(difference, distance > limits.doubtful, scale, limits.congruence);
    }
    std::printf("%-9s %5d steps, largest %6.1f standard deviations, %2d doubtful, noise grows by %.3f\n",
                name, steps, largest, doubtful, growing);
    EXPECT_GT(steps, 500) << name;
    EXPECT_LE(doubtful, steps / 100) << name;
  }
}

}  // namespace
}  // namespace egocal::test_congruence
