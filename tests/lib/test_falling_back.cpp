// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that moves and falls back is named with both times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "moves/segment_test.hpp"

namespace egocal::test_falling_back {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Two minutes with 1 % noise in which the mount of b moves at 42 s and moves again at 84 s.
SimulationOptions moved_twice(Terrain terrain, std::uint64_t seed, const Pose& first, const Pose& second) {
  SimulationOptions simulation;
  simulation.terrain = terrain;
  simulation.poses = 1201;
  simulation.relative_noise = 0.01;
  simulation.seed = seed;
  simulation.faults.resize(2);
  simulation.faults[1].mount_changes = {{42, 42, first}, {84, 84, second}};
  return simulation;
}

/// Number of findings mount_moved; `near`: of those at 42 or 84 s.
struct Named {
  int all = 0, near = 0;
};
Named named(const Calibration& calibration) {
  Named result;
  for (const Finding& finding : calibration.findings) {
    if (finding.code != "mount_moved") continue;
    ++result.all;
    result.near += std::min(std::abs(*finding.time - 42), std::abs(*finding.time - 84)) < 4;
  }
  return result;
}

TEST(FallingBack, IsNamedWithBothTimes) {
  int drives = 0, found = 0;
  std::uint64_t seed = 0;
  for (const double size : {1.0, 2.0, 5.0, 10.0})
    for (const Terrain terrain : {Terrain::rough, Terrain::free})
      for (const bool heavy_tails : {false, true}) {
        testing::Random random(++seed);
        const Pose change{rotation_exp(size * degree * random.direction()), {0, 0, 0}};
        SimulationOptions simulation = moved_twice(terrain, seed, change, inverse(change));
        simulation.heavy_tails = heavy_tails;
        const testing::Streams streams = testing::simulated_drive(simulation);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Named moves = named(calibration);
        ++drives;
        found += moves.all == 2 && moves.near == 2;
        const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b));
        if (error.rotation > degree) {
          EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
        }
      }
  std::printf("of %d drives %d are named with both times\n", drives, found);
  EXPECT_GE(found, drives - 1);
}

TEST(FallingBack, IsSaidInPlainWords) {
  const Pose change{rotation_exp({0, 2 * degree, 0}), {0, 0, 0}};
  const SimulationOptions simulation = moved_twice(Terrain::free, 3, change, inverse(change));
  const testing::Streams streams = testing::simulated_drive(simulation);
  const Calibration calibration = calibrate(streams.a, streams.b);
  ASSERT_EQ(named(calibration).near, 2) << calibration.reason;
  const Finding* first = testing::find(calibration, "mount_moved");
  const Finding& second = *(first + 1);
  double turn = 0, time = 0, before = 0;
  EXPECT_EQ(std::sscanf(second.message.c_str(),
                        "The mounting changed by %lf deg about %lf s after the start, back to where it was "
                        "before %lf s.",
                        &turn, &time, &before),
            3)
      << second.message;
  EXPECT_NEAR(turn, 2, 0.2);
  EXPECT_NEAR(time, 84, 2);
  EXPECT_NEAR(before, 42, 2);
  EXPECT_EQ(first->message.find("back to"), std::string::npos) << first->message;
  EXPECT_EQ(first->remedy, second.remedy);
  EXPECT_NE(second.remedy.find("separately"), std::string::npos) << second.remedy;
  // the answer after the second change is that before the first one
  const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*second.T_a_b));
  EXPECT_LT(error.rotation, 0.3 * degree);
}

// Motions of large moves contradict each other, which is looked at by two fits as well: these know one
// change.
TEST(FallingBack, OfTwelveDegreesHasBothTimesToo) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    testing::Random random(seed + 50);
    const Pose change{rotation_exp(12 * degree * random.direction()), 0.1 * random.direction()};
    SimulationOptions simulation = moved_twice(Terrain::rough, seed, change, inverse(change));
    simulation.relative_noise = 0.004;
    simulation.speed_variation = 1;
    const testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Named moves = named(calibration);
    EXPECT_EQ(moves.all, 2) << seed << ": " << calibration.reason;
    EXPECT_EQ(moves.near, 2) << seed << ": " << calibration.reason;
  }
}

TEST(FallingBack, TwoMovesThatCancelInPartAreTwoMoves) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    testing::Random random(seed);
    const Eigen::Vector3d turn = 3 * degree * random.direction(), rest = degree * random.direction();
    const SimulationOptions simulation =
        moved_twice(seed % 2 == 0 ? Terrain::rough : Terrain::free, seed, {rotation_exp(turn), {0, 0, 0}},
                    {rotation_exp(rest - turn), {0, 0, 0}});
    const testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Named moves = named(calibration);
    found += moves.all == 2 && moves.near == 2;
    for (const Finding& finding : calibration.findings)
      EXPECT_EQ(finding.message.find("back to where"), std::string::npos) << seed << finding.message;
  }
  EXPECT_GE(found, 5);
}

/// Blocks with a curvature and noise of its shape each; those of a part have another extrinsic.
std::vector<detail::LinearBlock> random_blocks(testing::Random& random, std::size_t count,
                                               const detail::Part& part, double change) {
  std::vector<detail::LinearBlock> blocks;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Matrix<double, 6, 6> root;
    for (Eigen::Index k = 0; k < 36; ++k) root(k) = random.normal();
    root = root * root.transpose() + Eigen::Matrix<double, 6, 6>::Identity();
    Eigen::Matrix<double, 6, 1> noise;
    for (Eigen::Index k = 0; k < 6; ++k) noise[k] = random.normal();
    detail::LinearBlock block;
    block.root = root;
    block.inverse_root = root.inverse();
    block.H = root * root;
    block.g = root * noise;
    if (part.has(i)) block.g -= change * block.H.col(0);
    blocks.push_back(block);
  }
  return blocks;
}

TEST(FallingBack, TheChanceOfAPartHoldsWhereverItIsLookedFor) {
  constexpr int trials = 400;
  testing::Random random(1);
  int below = 0;
  for (int i = 0; i < trials; ++i) {
    const auto blocks = random_blocks(random, i % 2 == 0 ? 40 : 128, {}, 0);
    below += detail::test_segment(blocks, 2, 6, {}).chance < 0.1;
  }
  RecordProperty("below", below);
  EXPECT_LE(below, trials / 10);
}

TEST(FallingBack, APartIsFoundWhereItIs) {
  testing::Random random(2);
  for (const detail::Part part : {detail::Part{9, 21}, detail::Part{60, 115}, detail::Part{31, 70}}) {
    const detail::SegmentTest test = detail::test_segment(random_blocks(random, 128, part, 0.4), 4, 12, {});
    EXPECT_LT(test.chance, 1e-9);
    EXPECT_NEAR(static_cast<double>(test.part.from), static_cast<double>(part.from), 2);
    EXPECT_NEAR(static_cast<double>(test.part.to), static_cast<double>(part.to), 2);
    EXPECT_NEAR(test.change[0], 0.4, 4 * std::sqrt(test.covariance(0, 0)));
    EXPECT_LT(test.chance_of_halves, 1e-3);
    EXPECT_LT(test.rest_by_change, 0.5);
  }
}

// As two lidars on KITTI 05: one of them errs in one place, for a part of the time that is looked for.
TEST(FallingBack, HalfOfAPartThatDiffersIsNoPart) {
  testing::Random random(3);
  const detail::SegmentTest test = detail::test_segment(random_blocks(random, 128, {50, 54}, 1), 4, 12, {});
  EXPECT_LT(test.chance, 1e-6);
  EXPECT_GT(test.chance_of_halves, 1e-2);
}

TEST(FallingBack, TheRestOfACourseInStepsDiffers) {
  testing::Random random(4);
  std::vector<detail::LinearBlock> blocks = random_blocks(random, 128, {40, 80}, 1);
  for (std::size_t i = 80; i < 128; ++i) blocks[i].g -= 0.75 * blocks[i].H.col(0);
  const detail::SegmentTest test = detail::test_segment(blocks, 4, 12, {});
  EXPECT_LT(test.chance_of_rest, 1e-6);
  EXPECT_GT(test.rest_by_change, 0.5);
}

}  // namespace
}  // namespace egocal::test_falling_back
