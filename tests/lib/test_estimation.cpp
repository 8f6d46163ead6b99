// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/verdict/stability.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/stride_sums.hpp"
#include "problem/motion_square.hpp"

namespace egocal::test_estimation {
namespace {

using testing::displacement;
using testing::Random;

/// White noise on every pose of both streams [rad, m].
testing::Streams with_pose_noise(testing::Streams streams, double rotation, double translation,
                                 std::uint64_t seed) {
  Random random(seed);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory)
      pose.pose = pose.pose * testing::normal_displacement(random, rotation, translation);
  return streams;
}

testing::Streams free_drive(std::uint64_t seed, double noise = 0) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = 201;
  options.relative_noise = noise;
  options.seed = seed;
  return testing::simulated_drive(options);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double error_of(const testing::Streams& s, const MotionPairing& drive, bool rotation) {
  const ExtrinsicError error = extrinsic_error(s.T, solve(drive.problem(), Method::dual).T_a_b);
  return rotation ? error.rotation : error.translation;
}

/// Noise on poses is the same however long a motion is: long motions say more than neighbours do.
TEST(Estimation, SumsOverStridesBeatNeighboursWhereNoiseIsOnPoses) {
  std::vector<double> sums, neighbours;
  for (std::uint64_t seed = 1; seed <= 7; ++seed) {
    const testing::Streams s = with_pose_noise(free_drive(seed), 0.005, 0.05, seed);
    const MotionPairing drive = paired({}, s.a, s.b);
    EXPECT_GT(drive.choice().mean_stride, 2) << seed;
    sums.push_back(error_of(s, drive, true));
    PairingOptions plain;
    plain.stride = 1;
    plain.balance = Balance{1, 0.01};
    neighbours.push_back(error_of(s, paired(plain, s.a, s.b), true));
  }
  EXPECT_LT(median(sums), 0.6 * median(neighbours));
}

/// Noise whose size changes from step to step by a factor of three (log-normal), in both sensors.
testing::Streams with_heavy_tails(testing::Streams streams, std::uint64_t seed) {
  Random random(seed);
  for (Trajectory* trajectory : {&streams.a, &streams.b}) {
    DualQuaternion before = trajectory->front().pose, noisy = before;
    for (StampedPose& pose : *trajectory) {
      const double times = std::exp(1.5 * random.normal());
      noisy = normalized(noisy * conjugate(before) * pose.pose *
                         testing::normal_displacement(random, 0.0005 * times, 0.005 * times));
      before = std::exchange(pose.pose, noisy);
    }
  }
  return streams;
}

DualQuaternion summed(const testing::Streams& s, const StrideSumsOptions& tuning) {
  StrideSums sums(validated(PairingOptions{}), tuning);
  sums.begin(s.a[1].time_us - s.a[0].time_us);
  for (std::size_t i = 0; i < s.a.size(); ++i) {
    sums.add({s.a[i].time_us, s.a[i].pose, s.b[i].pose, 0, i + 1});
    if (sums.choice_is_due()) sums.choose();
  }
  sums.choose();
  return sums.choice().value().q;
}

TEST(Estimation, StepsFarFromTypicalLoseWeightWhereTailsAreHeavy) {
  std::vector<double> weighted, alike;
  StrideSumsOptions off;
  off.jumps.doubtful = 1e9;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const testing::Streams s = with_heavy_tails(free_drive(seed), seed);
    weighted.push_back(extrinsic_error(s.T, summed(s, {})).rotation);
    alike.push_back(extrinsic_error(s.T, summed(s, off)).rotation);
  }
  EXPECT_LT(median(weighted), 0.85 * median(alike));
}

TEST(Estimation, WithoutHeavyTailsNoStepLosesWeight) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams s = free_drive(seed, 0.02);
    std::vector<MeasuredStep> steps;
    for (std::size_t i = 1; i < s.a.size(); ++i)
      steps.emplace_back(Step{motion_between(s.a[i - 1].pose, s.a[i].pose),
                              motion_between(s.b[i - 1].pose, s.b[i].pose), true});
    for (const StepVerdict& verdict : find_jumps(steps, {}, Mode::spatial, std::nullopt))
      EXPECT_EQ(verdict.extra_variance, 0) << seed;
  }
}

/// Tracking that is lost and found again elsewhere: no motion spans it.
TEST(Estimation, LastingJumpsBelowTheScreeningAreFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    testing::Streams s = with_pose_noise(free_drive(seed), 0.001, 0.01, seed);
    const double clean = error_of(s, paired({}, s.a, s.b), false);
    const DualQuaternion jump = displacement({0, 0, 0}, {0, 0.5, 0.5});
    for (std::size_t i = 100; i < s.b.size(); ++i) s.b[i].pose = jump * s.b[i].pose;
    const MotionPairing jumped = paired({}, s.a, s.b);
    EXPECT_GE(jumped.counts().jumps, 1u) << seed;
    EXPECT_LE(jumped.counts().jumps, 3u) << seed;
    EXPECT_LT(error_of(s, jumped, false), 1.5 * clean + 0.01) << seed;
  }
}

/// A hundred poses of a hand that shakes around one place, noise of 1 mrad and 1 mm on each.
/// b jumps four times by 20 cm and 0.05 rad.
testing::Streams shaken_with_four_jumps(std::uint64_t seed) {
  Random random(seed);
  testing::Streams s;
  s.T = displacement(random.normal3(1), random.normal3(0.4));
  DualQuaternion jumps = displacement({0, 0, 0}, {0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    const std::int64_t time_us = 1'000'000 * i;
    const DualQuaternion pose = displacement(random.normal3(0.3), random.normal3(0.1));
    if (i % 23 == 12) jumps = jumps * displacement(0.05 * random.direction(), 0.2 * random.direction());
    s.a.push_back({time_us, pose});
    s.b.push_back({time_us, jumps * pose * s.T});
  }
  return with_pose_noise(std::move(s), 0.001, 0.001, seed);
}

/// Motions of one stride that are judged one by one may keep those across a jump, which the sums lack.
TEST(Estimation, OneStrideThatSpansJumpsDoesNotReplaceSumsThatDoNot) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const testing::Streams s = shaken_with_four_jumps(seed);
    const MotionPairing drive = paired({}, s.a, s.b);
    EXPECT_LT(error_of(s, drive, false), 0.002) << seed << ": " << drive.choice().reason;
    EXPECT_GE(drive.counts().jumps, 1u) << seed;
  }
}

/// Omitting a block omits every motion that touches it; the sum of the blocks is every motion once.
TEST(Estimation, TheBlocksOfOverlappingMotionsAddUpToTheWhole) {
  Random random(1);
  StrideBlocks blocks(std::vector<int>{1, 3, 8});
  std::vector<DualQuaternion> poses{{}};
  Statistics expected;
  const StrideWeights weights{{2, 1, 0.5}, {0.3, 0.2, 0.1}};
  for (std::uint64_t i = 0; i < 300; ++i) {
    if (i > 0) poses.push_back(poses.back() * testing::normal_displacement(random, 0.1, 1));
    blocks.add_instant(i);
    for (std::size_t k = 0; k < blocks.strides().size(); ++k) {
      const auto steps = static_cast<std::uint64_t>(blocks.strides()[k].stride);
      if (steps > i) continue;
      const DualQuaternion motion = motion_between(poses[i - steps], poses[i]);
      const DualQuaternion other = motion * testing::normal_displacement(random, 0.01, 0.1);
      blocks.add(k, i - steps, detail::MotionSquare(motion, other), false, 1);
      StrideCell one;
      one.motions.add(motion, other);
      add_weighted(expected, one, weights.rotation[k], weights.translation[k]);
    }
  }
  Problem problem;
  const WeightedBlocks weighted = TouchingSums(blocks).weighted(weights);
  weighted.fill(problem);
  EXPECT_LE(problem.blocks.size(), StrideBlocks::most_blocks + 1);
  const Statistics all = sum_blocks(problem.blocks);
  EXPECT_NEAR(all.weight, expected.weight, 1e-9 * expected.weight);
  EXPECT_LT((all.dual_rows - expected.dual_rows).norm(), 1e-9 * expected.dual_rows.norm());
}

/// Whether a fifth of the drive can be omitted is asked of touching blocks as of disjoint ones.
TEST(Estimation, TouchingBlocksAreAsStableAsTheDriveIs) {
  const testing::Streams s = with_pose_noise(free_drive(2), 0.005, 0.05, 2);
  const MotionPairing drive = paired({}, s.a, s.b);
  const auto spread = [](const Problem& problem) {
    return detail::spread_without_fifths(problem, solve(problem, Method::dual).T_a_b);
  };
  const auto touching = spread(drive.problem()), disjoint = spread(drive.single_stride_problem());
  ASSERT_GT(drive.choice().mean_stride, 0);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_GT(touching[i], 0) << i;
    EXPECT_LT(touching[i], 4 * disjoint[i]) << i;
  }
}

/// Continuing from the state gives the same bits, and what is kept up to date motion by motion is the sum of
/// all.
TEST(Estimation, StrideSumsContinueFromTheirState) {
  const testing::Streams s = with_pose_noise(free_drive(3), 0.005, 0.05, 3);
  const auto run = [&](std::size_t cut) {
    StrideSums sums{PairingOptions{}};
    sums.begin(100'000);
    for (std::size_t i = 0; i < s.a.size(); ++i) {
      if (i == cut) sums = StrideSums(PairingOptions{}, {}, StrideSumsState(sums.state()));
      sums.add({s.a[i].time_us, s.a[i].pose, s.b[i].pose, 0, i + 1});
      if (sums.choice_is_due()) sums.choose();
    }
    Problem problem;
    sums.fill(problem);
    return cost_matrix(problem);
  };
  const Matrix8d expected = run(s.a.size());
  EXPECT_GT(expected.norm(), 0);
  for (const std::size_t cut : {10u, 99u, 150u, 199u}) EXPECT_EQ(run(cut), expected) << cut;
}

/// What only the answers need may be done after every pose, at the end, or when it is asked for.
TEST(Estimation, StrideSumsSettledLaterHaveTheSameBits) {
  testing::Streams s = with_heavy_tails(with_pose_noise(free_drive(4), 0.005, 0.05, 4), 4);
  const std::size_t middle = s.a.size() / 2;
  for (std::size_t i = middle; i < s.a.size(); ++i) s.a[i].pose.dual += QuaternionVector(0, 0.5, 0, 0);
  for (StampedPose& pose : s.a) pose.pose = normalized(pose.pose);
  StrideSumsOptions tuning;
  tuning.most_open = 64;  // most instants are committed before the end
  StrideSums each{PairingOptions{}, tuning}, end{PairingOptions{}, tuning};
  int compared = 0;
  for (StrideSums* sums : {&each, &end}) sums->begin(100'000);
  for (std::size_t i = 0; i < s.a.size(); ++i) {
    for (StrideSums* sums : {&each, &end}) {
      sums->add({s.a[i].time_us, s.a[i].pose, s.b[i].pose, 0, i + 1});
      if (sums->choice_is_due()) sums->choose();
    }
    each.settle();
    if (i % 17 != 0 || !each.in_force()) continue;
    ++compared;
    Problem settled, asked;
    each.fill(settled);
    end.fill(asked);
    EXPECT_EQ(cost_matrix(settled), cost_matrix(asked)) << i;
    const auto blocks = each.state().weighted.state().blocks, later = end.state().weighted.state().blocks;
    ASSERT_EQ(blocks.size(), later.size());
    for (std::size_t k = 0; k < blocks.size(); ++k)
      EXPECT_EQ(blocks[k].dual_rows, later[k].dual_rows) << i << ' ' << k;
  }
  EXPECT_GT(compared, 5);
}

/// Noise that adds up from motion to motion is what neighbours show best; given settings are kept.
TEST(Estimation, GivenSettingsAndPlainWeightsAreNeverSummed) {
  const testing::Streams s = with_pose_noise(free_drive(1), 0.005, 0.05, 1);
  PairingOptions stride, equal, plain;
  stride.stride = 1;
  equal.balance = Balance{};
  plain.robust = false;
  for (const PairingOptions& options : {stride, equal, plain}) {
    const MotionPairing drive = paired(options, s.a, s.b);
    EXPECT_EQ(drive.choice().mean_stride, 0);
    for (const Statistics& block : drive.problem().blocks) EXPECT_GT(block.weight, 0);
  }
}

}  // namespace
}  // namespace egocal::test_estimation
