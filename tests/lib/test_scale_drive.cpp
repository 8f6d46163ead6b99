// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The scale of a sensor one pose at a time: as good as offline, robust, and resumed to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../support/simulated_drive.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/scale/scale_drive.hpp"

namespace egocal {
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
}  // namespace egocal
