// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Which noise the residuals of many strides explain, and that no memory is tried where they do.
#include "estimation/noise_growth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/online/answer.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_noise_growth {
namespace {

const std::vector<double> growths{0, 0.01, 0.1, 1, 10};

TEST(NoiseGrowth, IsWhatTheVariancesShowBeyondDoubt) {
  const std::vector<double> strides{4, 8, 16, 32}, independent{25, 12, 6, 3};
  EXPECT_EQ(detail::least_growth({strides, {2.4, 2.8, 3.6, 5.2}, {2500, 1200, 600, 300}}, growths, 1), 0.1);
  EXPECT_EQ(detail::least_growth({strides, {2.0, 2.0, 2.1, 2.2}, independent}, growths, 1), 0);
}

TEST(NoiseGrowth, NoiseOnPosesAndOnMotionsIsExplainedAndNoiseThatWandersIsNot) {
  const std::vector<double> strides{1, 2, 4, 8, 16, 32};
  std::vector<double> independent, mixed, wandering, wandering_poses;
  for (const double stride : strides) {
    independent.push_back(300 / stride);
    mixed.push_back(7e-6 * (2 + 0.1 * stride));
    double sum = stride;  // variance of a sum of steps whose noise has the correlation 0.8 from step to step
    for (double lag = 1; lag < stride; ++lag) sum += 2 * (stride - lag) * std::pow(0.8, lag);
    wandering.push_back(sum);
    wandering_poses.push_back(1 - std::pow(0.8, stride));
  }
  const detail::NoiseFit fit = detail::fit_noise({strides, mixed, independent}, growths, 3);
  EXPECT_LT(fit.misfit, 1e-9);
  EXPECT_FALSE(fit.refutes(0.1, 1));
  EXPECT_TRUE(fit.refutes(10, 3));  // noise on motions alone
  EXPECT_TRUE(fit.refutes(0, 1));
  EXPECT_GT(detail::fit_noise({strides, wandering, independent}, growths, 3).misfit, 10);
  EXPECT_GT(detail::fit_noise({strides, wandering_poses, independent}, growths, 3).misfit, 2.5);
}

TEST(NoiseGrowth, TooFewStridesExplainNothing) {
  EXPECT_EQ(detail::fit_noise({{1, 2, 4}, {1, 2, 4}, {30, 15, 2}}, growths, 3).misfit,
            std::numeric_limits<double>::infinity());
}

/// The smallest of several spreads that scatter was in force in half of such drives.
TEST(NoiseGrowth, DrivesWithNoiseOnMotionsAreWeighedByTheirResiduals) {
  int by_spread = 0, seen = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const testing::Streams streams =
        testing::simulated_drive({.poses = 301, .relative_noise = 0.01, .seed = seed});
    const PairingResult result = pair_motions({}, streams.a, streams.b);
    by_spread += result.drive.choice().reason.find("and the jack-knife") != std::string::npos;
    const Answer answer = solve(result.drive.problem(), Method::dual);
    const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
    for (std::size_t i = 0; i < 6; ++i) {
      if (!answer.observability.observable[i]) continue;
      ++seen;
      covered += std::abs(error[static_cast<Eigen::Index>(i)]) <= 1.96 * answer.observability.stddev[i];
    }
  }
  EXPECT_LE(by_spread, 2);
  EXPECT_GE(covered, 0.92 * seen) << covered << " of " << seen;
}

/// Noise on poses makes rotations of all strides alike, but translations worse the longer a motion is: by its
/// rotation noise times its length. That was taken for noise on motions, and short motions were preferred.
TEST(NoiseGrowth, RotationNoiseInLongMotionsIsNotNoiseOnMotions) {
  double strides = 0;
  const int drives = 8;
  for (std::uint64_t seed = 1; seed <= drives; ++seed) {
    testing::Streams streams =
        testing::simulated_drive({.terrain = Terrain::free, .poses = 101, .relative_noise = 0, .seed = seed});
    testing::Random random(seed);
    for (Trajectory* stream : {&streams.a, &streams.b})
      for (auto& stamped : *stream) {
        Pose pose = to_pose(stamped.pose);
        pose.translation += random.normal3(0.01);                                            // [m]
        pose.rotation = (pose.rotation * rotation_exp(random.normal3(0.004))).normalized();  // [rad]
        stamped.pose = to_dual_quaternion(pose);
      }
    strides += pair_motions({}, streams.a, streams.b).drive.choice().mean_stride / drives;
  }
  EXPECT_GT(strides, 4);
}

}  // namespace
}  // namespace egocal::test_noise_growth
