// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Standard deviations of short drives with noise on poses. Long motions are best there, and most of them lie
// in two blocks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/online/answer.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_touching_blocks {
namespace {

/// Mean length [rad, m] of a step.
std::array<double, 2> size_of_steps(const Trajectory& trajectory) {
  std::array<double, 2> mean{};
  const auto steps = static_cast<double>(trajectory.size() - 1);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose step = to_pose(conjugate(trajectory[i - 1].pose) * trajectory[i].pose);
    mean[0] += 2 * std::acos(std::min(1.0, std::abs(step.rotation.w()))) / steps;
    mean[1] += step.translation.norm() / steps;
  }
  return mean;
}

/// White noise on the poses of both sensors: this part of a step.
testing::Streams noisy_poses(SimulationOptions options, double part) {
  testing::Streams streams = testing::simulated_drive(options);
  testing::Random random(1000 + options.seed);
  for (Trajectory* trajectory : {&streams.a, &streams.b}) {
    const auto [turn, shift] = size_of_steps(*trajectory);
    for (StampedPose& pose : *trajectory) {
      const Eigen::Vector3d rotation = random.normal3(part * turn),
                            translation = random.normal3(part * shift);
      pose.pose = pose.pose * testing::displacement(rotation, translation);
    }
  }
  return streams;
}

struct Spreads {
  double stddev_to_error = 0;  ///< root mean squares
  double covered = 0;          ///< part within 1.96 standard deviations
  double largest = 0;          ///< standard deviation, in medians of its direction
};

Spreads spreads_of(Terrain terrain, double noise_on_motions, double noise_on_poses) {
  std::array<std::vector<double>, 6> stddevs;
  double squares = 0, covered = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    SimulationOptions options;
    options.terrain = terrain;
    options.poses = 101;
    options.relative_noise = noise_on_motions;
    options.seed = seed;
    const testing::Streams streams = noisy_poses(options, noise_on_poses);
    const Answer answer = solve(pair_motions({}, streams.a, streams.b).drive.problem(), Method::dual);
    const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
    for (std::size_t i = 0; i < 6; ++i) {
      if (!answer.observability.observable[i]) continue;
      const double stddev = answer.observability.stddev[i];
      const double ratio = error[static_cast<Eigen::Index>(i)] / stddev;
      stddevs[i].push_back(stddev);
      squares += ratio * ratio;
      covered += std::abs(ratio) <= 1.96;
      count += 1;
    }
  }
  Spreads spreads{std::sqrt(count / squares), covered / count, 0};
  for (std::vector<double>& of_direction : stddevs) {
    std::sort(of_direction.begin(), of_direction.end());
    spreads.largest = std::max(spreads.largest, of_direction.back() / of_direction[of_direction.size() / 2]);
  }
  return spreads;
}

TEST(TouchingBlocks, NoiseOnPosesHasItsSpread) {
  const Spreads spreads = spreads_of(Terrain::free, 0, 0.05);
  EXPECT_GT(spreads.stddev_to_error, 0.9);
  EXPECT_LT(spreads.stddev_to_error, 1.3);
  EXPECT_GE(spreads.covered, 0.92);
}

TEST(TouchingBlocks, NoDriveHasASpreadOutOfProportion) {
  const Spreads spreads = spreads_of(Terrain::free, 0.01, 0.03);
  EXPECT_LT(spreads.stddev_to_error, 1.8);
  EXPECT_GE(spreads.covered, 0.92);
  EXPECT_LT(spreads.largest, 4);
}

}  // namespace
}  // namespace egocal::test_touching_blocks
