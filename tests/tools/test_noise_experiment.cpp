// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "../support/paths.hpp"
#include "experiments/deviation.hpp"
#include "experiments/noise_slopes.hpp"
#include "experiments/noisy_drive.hpp"

namespace egocal::tools::test_noise_experiment {
namespace {

TEST(Deviations, AreWhatIsLeftWithoutTheSharedError) {
  const Deviations found = deviations({{1, 0, 0}, {3, 0, 0}, {2, 5, 0}, {2, -5, 0}});
  EXPECT_EQ(found.common, Eigen::Vector3d(2, 0, 0));
  EXPECT_THAT(found.lengths, ::testing::ElementsAre(1, 1, 5, 5));
  EXPECT_TRUE(deviations({}).lengths.empty());
}

TEST(NoisyDrive, MovesAsTheExampleOfThePaper) {
  const NoisyDrive drive(DriveOptions{}, Pose{});
  EXPECT_NEAR(drive.mean_translation(), 1, 0.1);
  EXPECT_NEAR(drive.mean_rotation(), 0.1, 0.01);
}

TEST(NoisyDrive, HasTheNoiseThatWasAskedFor) {
  const Pose T{rotation_exp({0.1, 0.2, 2}), {1, 2, 0.5}};
  const NoisyDrive drive(DriveOptions{}, T);
  const std::vector<MotionPair> clean = drive.run(0, false, 1), noisy = drive.run(0.1, false, 1),
                                again = drive.run(0.1, false, 1), other = drive.run(0.1, false, 2);
  ASSERT_EQ(clean.size(), 1000u);
  double rotation = 0, translation = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const Pose noise = to_pose(conjugate(clean[i].a) * noisy[i].a);
    rotation += rotation_log(noise.rotation).squaredNorm() / 3000;
    translation += noise.translation.squaredNorm() / 3000;
    EXPECT_EQ(noisy[i].b.real, again[i].b.real);
  }
  EXPECT_NEAR(std::sqrt(rotation), 0.1 * drive.mean_rotation(), 0.005 * drive.mean_rotation());
  EXPECT_NEAR(std::sqrt(translation), 0.1 * drive.mean_translation(), 0.005 * drive.mean_translation());
  EXPECT_NE(noisy[0].a.real, other[0].a.real);
}

TEST(Noise, ErrorsFallWithThePairsAndRiseWithTheNoise) {
  NoiseOptions options;
  options.levels = {0.01, 0.1};
  options.most_pairs = 400;
  options.sizes = 3;
  options.sensors = 3;
  options.repeats = 4;
  const std::vector<NoisePoint> points = noise_experiment(options, {});
  ASSERT_EQ(points.size(), 6u);
  EXPECT_LT(points[2].rotation.median, points[0].rotation.median);
  EXPECT_LT(points[2].rotation.median, points[5].rotation.median);
  EXPECT_LE(points[2].rotation.lower_quartile, points[2].rotation.median);
  EXPECT_LE(points[2].rotation.median, points[2].rotation.upper_quartile);
  for (const NoisePoint& point : points) EXPECT_EQ(point.certified, point.runs);
}

TEST(Noise, SlopesAreTheMeanOfThoseOfTheRuns) {
  std::vector<NoisePoint> points;
  for (const int n : {50, 200, 400, 800}) {
    NoisePoint point;
    point.level = 0.1;
    point.pairs = n;
    // too few pairs are not looked at; one run falls with -0.4, one with -0.6
    const double few = n < 100 ? 7 : 1;
    point.translations = {few * 3 * std::pow(n, -0.4), few * 8 * std::pow(n, -0.6)};
    point.rotations = {0.1 / n, 0.3 / n};
    point.corrected_translations = point.translations;
    point.translation_deviations = point.rotation_deviations = {1 / std::sqrt(n), 2 / std::sqrt(n)};
    point.shortened = 1.0 / n;
    points.push_back(point);
  }
  const std::vector<NoiseSlope> found = slopes(points);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].translation.mean, -0.5, 1e-9);
  EXPECT_NEAR(found[0].translation.standard_error, 0.1, 1e-9);
  EXPECT_NEAR(found[0].rotation.mean, -1, 1e-9);
  EXPECT_NEAR(found[0].rotation.standard_error, 0, 1e-9);
  EXPECT_NEAR(found[0].translation_spread.mean, -0.5, 1e-9);
  EXPECT_NEAR(found[0].rotation_spread.mean, -0.5, 1e-9);
  EXPECT_EQ(found[0].shortened, 1.0 / 800);
}

/// docs/paper.md has this table, made by this size of the experiment.
TEST(Noise, ErrorsFallWithTheRootOfTheNumberOnceTheNoiseIsTakenOff) {
  NoiseOptions options;
  options.sizes = 12;
  options.sensors = 8;
  options.repeats = 64;
  options.mixed = true;
  const std::vector<NoiseSlope> found = slopes(noise_experiment(options, {}));
  ASSERT_EQ(found.size(), 6u);
  for (const NoiseSlope& slope : found)
    for (const Exponent& exponent :
         {slope.corrected_translation, slope.translation_spread, slope.rotation_spread, slope.rotation}) {
      EXPECT_LT(exponent.standard_error, 0.035) << slope.level;
      EXPECT_NEAR(exponent.mean, -0.5, 0.05) << slope.level;
    }
  // the attenuation of least squares with noise on both sides: k s^2 / (1 + k s^2)
  const auto attenuation = [&](std::size_t level) {
    const double part = found[level].shortened;
    return part / (1 - part) / (found[level].level * found[level].level);
  };
  EXPECT_NEAR(attenuation(5) / attenuation(4), 1, 0.1);
  EXPECT_NEAR(attenuation(4) / attenuation(3), 1, 0.1);
  std::ifstream page(paths::source_dir() + "/docs/paper.md");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  EXPECT_THAT(text, ::testing::HasSubstr(markdown(found)));
}

}  // namespace
}  // namespace egocal::tools::test_noise_experiment
