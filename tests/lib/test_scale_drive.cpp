// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The scale of a sensor one pose at a time: as good as offline, robust, and resumed to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../support/simulated_drive.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/scale/scale_drive.hpp"

namespace egocal::test_scale_drive {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

SimulationOptions drive(std::uint64_t seed, Terrain terrain, double scale, int poses = 1201) {
  SimulationOptions options;
  options.terrain = terrain;
  options.seed = seed;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.faults.resize(2);
  options.faults[1].scale = scale;
  return options;
}

ScaleDriveOptions of_b() {
  ScaleDriveOptions options;
  options.scale.side = Side::b;
  return options;
}

/// Poses [from, to) of both streams.
void push(ScaleDrive& scale_drive, const testing::Streams& streams, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    scale_drive.push(Side::a, streams.a[i]);
    scale_drive.push(Side::b, streams.b[i]);
  }
}

TEST(ScaleDrive, FindsScaleAndExtrinsicOfASimulatedCamera) {
  int within = 0, drives = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free})
      for (const double scale : {0.05, 2.7}) {
        ++drives;
        const testing::Streams streams = testing::simulated_drive(drive(seed, terrain, scale));
        ScaleDrive scale_drive(of_b());
        push(scale_drive, streams, 0, streams.a.size());
        ASSERT_TRUE(scale_drive.known()) << seed << " " << scale;
        const ScaleSolution& solution = scale_drive.solution();
        EXPECT_NEAR(solution.scale, scale, 0.005 * scale);
        within += std::abs(solution.scale - scale) < 3 * solution.stddev;
        const Answer answer = solve(*scale_drive.problem(), Method::dual);
        EXPECT_EQ(answer.certificate.optimality, Optimality::certified);
        const auto error = extrinsic_error(streams.T, answer.T_a_b);
        EXPECT_LT(error.rotation * degrees, 0.4);
        // a road hardly shows the height
        EXPECT_LT(error.translation, terrain == Terrain::free ? 0.05 : 0.3);
        const ScaleProblem& problem = *scale_drive.scale_problem();
        EXPECT_EQ(solve_scale(problem.blocks, problem.options).scale, solution.scale)
            << "every receiver can check it";
      }
  EXPECT_GE(within, drives - 1);
}

TEST(ScaleDrive, IsResumedToTheBit) {
  const testing::Streams streams = testing::simulated_drive(drive(3, Terrain::free, 0.37, 2401));
  ScaleDrive whole(of_b());
  push(whole, streams, 0, streams.a.size());
  for (const std::size_t cut : {100u, 1111u, 1800u}) {
    ScaleDrive first(of_b());
    push(first, streams, 0, cut);
    ScaleDrive second(of_b(), first.state());
    push(second, streams, cut, streams.a.size());
    EXPECT_EQ(second.solution().scale, whole.solution().scale);
    EXPECT_EQ(second.solution().stddev, whole.solution().stddev);
    EXPECT_EQ(second.motions(), whole.motions());
  }
  EXPECT_LE(whole.state().recent.size(), of_b().most_recent);
  EXPECT_LE(whole.scale_problem()->blocks.size(), 64u);
}

TEST(ScaleDrive, JumpsOfTheCameraAreLeftOut) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SimulationOptions options = drive(seed, Terrain::rough, 0.37);
    options.faults[1].jumps = {{30.05, {rotation_exp({0, 0, 0.1}), {5, 2, 0}}},
                               {80.05, {rotation_exp({0.01, 0, 0}), {0, 1, 0}}}};
    const testing::Streams streams = testing::simulated_drive(options);
    ScaleDrive scale_drive(of_b());
    push(scale_drive, streams, 0, streams.a.size());
    ASSERT_TRUE(scale_drive.known());
    EXPECT_NEAR(scale_drive.solution().scale, 0.37, 0.005 * 0.37);
    EXPECT_GE(scale_drive.counts().outliers, 4u);
  }
}

TEST(ScaleDrive, TurningOnTheSpotShowsNoScale) {
  testing::Streams streams = testing::simulated_drive(drive(1, Terrain::free, 0.37, 601));
  // both sensors on the axis: all of their translations are noise
  for (std::size_t i = 0; i < streams.a.size(); ++i) {
    const auto noise = [i](double rate) { return 1e-3 * std::sin(rate * static_cast<double>(i * i)); };
    const Eigen::Vector3d turned(0, 0, 0.05 * static_cast<double>(i));
    streams.a[i].pose = to_dual_quaternion(Pose{rotation_exp(turned), {noise(1.7), noise(0.9), noise(2.3)}});
    streams.b[i].pose = to_dual_quaternion(Pose{rotation_exp(turned), {noise(1.1), noise(2.9), noise(0.4)}});
  }
  ScaleDrive scale_drive(of_b());
  push(scale_drive, streams, 0, streams.a.size());
  EXPECT_GT(scale_drive.motions(), 100u);
  EXPECT_FALSE(scale_drive.known());
  EXPECT_FALSE(scale_drive.problem());
}

/// Path in free motion that changes 40 times a second; poses of the two sensors at these rates.
testing::Streams unsynchronised(std::uint64_t seed, double rate_a, double rate_b) {
  SimulationOptions options = drive(seed, Terrain::free, 0.4, 4801);
  options.rate = 40;
  options.faults[0].rate = rate_a;
  options.faults[1].rate = rate_b;
  options.faults[1].phase = (0.1 + 0.1 * static_cast<double>(seed % 8)) / rate_b;
  return testing::simulated_drive(options);
}

/// In the order of time, or in bursts of one stream after the other.
ScaleDrive driven(const testing::Streams& streams, std::size_t burst) {
  ScaleDrive scale_drive(of_b());
  std::size_t i = 0, k = 0;
  while (i < streams.a.size() || k < streams.b.size()) {
    const bool from_a =
        k == streams.b.size() || (i < streams.a.size() && streams.a[i].time_us <= streams.b[k].time_us);
    for (std::size_t n = 0; n < burst; ++n) {
      if (from_a && i < streams.a.size()) scale_drive.push(Side::a, streams.a[i++]);
      if (!from_a && k < streams.b.size()) scale_drive.push(Side::b, streams.b[k++]);
    }
  }
  return scale_drive;
}

// Not cut alike the error is 1.2 % at 4 Hz and 0.15 % at 10 Hz.
TEST(ScaleDrive, WhatInterpolationTakesOffCancelsAndTheRestIsInTheStandardDeviation) {
  constexpr std::uint64_t drives = 6;
  const double rates[][2] = {{4, 4}, {10, 10}, {20, 20}, {10, 20}, {10, 30}, {40, 10}};
  for (const auto& [rate_a, rate_b] : rates) {
    double largest = 0, squares = 0, stddev = 0, standardised = 0;
    for (std::uint64_t seed = 1; seed <= drives; ++seed) {
      const ScaleDrive scale_drive = driven(unsynchronised(seed, rate_a, rate_b), 1);
      ASSERT_TRUE(scale_drive.known());
      const ScaleSolution& solution = scale_drive.solution();
      const double error = solution.scale / 0.4 - 1, sigma = solution.stddev / 0.4;
      squares += error * error / drives;
      stddev += sigma / drives;
      standardised += error * error / (sigma * sigma) / drives;
      largest = std::max(largest, std::abs(error) / sigma);
    }
    std::printf("%g and %g Hz: off by %.3f %%, standard deviation %.3f %%, at most %.1f of them\n", rate_a,
                rate_b, 100 * std::sqrt(squares), 100 * stddev, largest);
    SCOPED_TRACE(std::to_string(rate_a) + " and " + std::to_string(rate_b) + " Hz");
    EXPECT_LT(std::sqrt(squares), 0.0012);
    EXPECT_LT(std::sqrt(standardised), 1.6);
    EXPECT_LT(largest, 4);
    EXPECT_LT(stddev, 3 * std::sqrt(squares) + 0.0006) << "wider than it need be";
  }
}

TEST(ScaleDrive, StreamsMeasuredTogetherLoseNothing) {
  const testing::Streams streams = testing::simulated_drive(drive(1, Terrain::free, 0.37));
  EXPECT_LT(driven(streams, 1).scale_problem()->options.doubt, 1e-5);
  testing::Streams later = streams;  // a camera that starts a while after the lidar
  later.b.erase(later.b.begin(), later.b.begin() + 100);
  EXPECT_LT(driven(later, 1).scale_problem()->options.doubt, 1e-4);
}

TEST(ScaleDrive, HowTheStreamsInterleaveChangesNoBit) {
  const testing::Streams streams = unsynchronised(2, 10, 30);
  const ScaleDrive one = driven(streams, 1), bursts = driven(streams, 50);
  EXPECT_GT(one.scale_problem()->options.doubt, 1e-5);
  EXPECT_EQ(one.scale_problem()->options.doubt, bursts.scale_problem()->options.doubt);
  EXPECT_EQ(one.solution().scale, bursts.solution().scale);
  EXPECT_EQ(one.solution().stddev, bursts.solution().stddev);
}

TEST(ScaleDrive, AGapInTheStreamsEndsTheMotions) {
  testing::Streams streams = testing::simulated_drive(drive(2, Terrain::free, 0.37));
  for (std::size_t i = 300; i < streams.a.size(); ++i)
    for (Trajectory* trajectory : {&streams.a, &streams.b}) (*trajectory)[i].time_us += 20'000'000;
  ScaleDrive scale_drive(of_b());
  push(scale_drive, streams, 0, streams.a.size());
  for (const MotionPair& motion : scale_drive.state().recent)
    EXPECT_LT(motion.end_us - motion.begin_us, 2'000'000);
  ASSERT_TRUE(scale_drive.known());
  EXPECT_NEAR(scale_drive.solution().scale, 0.37, 0.005 * 0.37);
}

}  // namespace
}  // namespace egocal::test_scale_drive
