// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Still poses of which several share one pose of the arm, or are the same altogether.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/arm_samples.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::test_samples_repeats {
namespace {

using testing::ArmSamples;
using testing::Random;
using testing::SimulatedSamples;

constexpr double degree = std::numbers::pi / 180;

SimulatedSamples arm(std::size_t samples, std::uint64_t seed, double rotation_noise = 0.3,
                     double position_noise = 2) {
  ArmSamples what;
  what.samples = samples;
  what.rotation_noise = rotation_noise;
  what.position_noise = position_noise;
  Random random(seed);
  return testing::simulate_arm(what, random);
}

/// Several images at each pose of an arm, whose error they share.
struct Images {
  std::size_t poses = 10, at_first = 3, at_others = 3;
  double arm_rotation = 0.2, arm_position = 1;  ///< noise [deg], [mm]
  double image_rotation = 0.1, image_position = 0.5;
};

SimulatedSamples images(const Images& what, std::uint64_t seed) {
  SimulatedSamples drawn = arm(what.poses, seed, 0, 0);
  Random random(seed + 1000);
  std::vector<PoseSample> samples;
  for (std::size_t i = 0; i < what.poses; ++i) {
    const Pose hand = testing::noisy(to_pose(drawn.samples[i].a), what.arm_rotation * degree,
                                     1e-3 * what.arm_position, random);
    const Pose target = inverse(to_pose(drawn.samples[i].b));
    for (std::size_t k = 0; k < (i == 0 ? what.at_first : what.at_others); ++k) {
      const Pose image =
          testing::noisy(target, what.image_rotation * degree, 1e-3 * what.image_position, random);
      samples.push_back({to_dual_quaternion(hand), to_dual_quaternion(inverse(image))});
    }
  }
  drawn.samples = std::move(samples);
  return drawn;
}

/// Of an answer's six numbers those within 1.96 standard deviations of the truth.
int covered(const SimulatedSamples& drawn, const SampleCalibration& found) {
  const Pose truth = to_pose(drawn.X), &answer = found.calibration.T_a_b;
  Eigen::Matrix<double, 6, 1> off;
  off << answer.translation - truth.translation, rotation_log(answer.rotation * truth.rotation.conjugate());
  int count = 0;
  for (int i = 0; i < 6; ++i)
    if (std::abs(off[i]) < 1.96 * found.calibration.observability.stddev[static_cast<std::size_t>(i)])
      ++count;
  return count;
}

void expect_same_bits(const SampleCalibration& one, const SampleCalibration& other) {
  EXPECT_EQ(one.calibration.T_a_b.translation, other.calibration.T_a_b.translation);
  EXPECT_EQ(one.calibration.T_a_b.rotation.coeffs(), other.calibration.T_a_b.rotation.coeffs());
  EXPECT_EQ(one.calibration.observability.stddev, other.calibration.observability.stddev);
  EXPECT_EQ(one.spread_rms, other.spread_rms);
}

TEST(RepeatedSamples, CountOnceToTheLastBit) {
  const SimulatedSamples drawn = arm(6, 3);
  const SampleCalibration once = calibrate_samples(drawn.samples);
  std::vector<PoseSample> repeated;
  for (int k = 0; k < 5; ++k) repeated.insert(repeated.end(), drawn.samples.begin(), drawn.samples.end());
  for (std::size_t i = 0; i < repeated.size(); i += 4) repeated[i].b = -repeated[i].b;  // the same pose
  const SampleCalibration found = calibrate_samples(repeated);
  expect_same_bits(found, once);
  EXPECT_EQ(found.calibration.verdict, once.calibration.verdict);
  EXPECT_EQ(found.residuals.size(), 30u);
  EXPECT_EQ(found.calibration.counts.matched, 30u);
  EXPECT_EQ(found.repeated, 24u);
  EXPECT_EQ(found.different, 6u);
  EXPECT_EQ(once.repeated, 0u);
}

TEST(RepeatedSamples, ThatAreRejectedAreAllNamed) {
  ArmSamples what;
  what.wrong = 2;
  Random random(8);
  const SimulatedSamples drawn = testing::simulate_arm(what, random);
  std::vector<PoseSample> twice = drawn.samples;
  twice.insert(twice.end(), drawn.samples.begin(), drawn.samples.end());
  const SampleCalibration found = calibrate_samples(twice);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(found.residuals[i].wrong, drawn.wrong[i % 10]) << i;
  EXPECT_EQ(found.calibration.counts.outliers, 4u);
}

TEST(RepeatedSamples, OfOnePoseOfTheArmShareItsErrorInTheStandardDeviations) {
  Images uneven;
  uneven.at_first = 20;
  uneven.at_others = 1;
  Images many;
  many.poses = 35;
  many.at_first = 10;
  for (const Images& what : {Images(), uneven, many}) {
    int inside = 0, rejected = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const SimulatedSamples drawn = images(what, seed);
      const SampleCalibration found = calibrate_samples(drawn.samples);
      EXPECT_EQ(found.different, what.poses);
      rejected += found.calibration.counts.outliers > 0 ? 1 : 0;
      inside += covered(drawn, found);
    }
    EXPECT_LE(rejected, 2) << what.poses << " poses, " << what.at_first << " images at the first";
    EXPECT_GT(inside, 240 * 0.9) << what.poses << " poses, " << what.at_first << " images at the first";
  }
}

TEST(RepeatedSamples, DeviationsByOneStepAreThoseOfTheAnswersWithoutEachPose) {
  const SimulatedSamples drawn = images({12, 5, 3, 0.2, 1, 0.1, 0.5}, 5);
  SampleOptions stepped, solved;
  stepped.most_solved = 0;
  const SampleCalibration fast = calibrate_samples(drawn.samples, stepped),
                          slow = calibrate_samples(drawn.samples, solved);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(fast.calibration.observability.stddev[i] / slow.calibration.observability.stddev[i], 1, 0.02)
        << i;
}

TEST(RepeatedSamples, ShareAPoseAlsoWhereItsDigitsAreRounded) {
  const SimulatedSamples drawn = images({8, 3, 3, 0.2, 1, 0.1, 0.5}, 6);
  std::vector<PoseSample> rounded = drawn.samples;
  Random random(1);
  for (PoseSample& sample : rounded)
    sample.a = to_dual_quaternion(testing::noisy(to_pose(sample.a), 3e-7, 3e-7, random));
  EXPECT_EQ(calibrate_samples(rounded).different, 8u);
}

TEST(RepeatedSamples, ChangeNoBitInAnyOrder) {
  SimulatedSamples drawn = images({9, 4, 2, 0.2, 1, 0.1, 0.5}, 7);
  drawn.samples.push_back(drawn.samples[2]);
  drawn.samples.push_back({drawn.samples[5].a, drawn.samples[11].b});  // wrong: the image of another pose
  const SampleCalibration found = calibrate_samples(drawn.samples);
  EXPECT_EQ(found.calibration.counts.outliers, 1u);
  std::vector<PoseSample> shuffled = drawn.samples;
  Random random(3);
  for (int shuffle = 0; shuffle < 5; ++shuffle) {
    for (std::size_t i = shuffled.size() - 1; i > 0; --i)
      std::swap(shuffled[i], shuffled[random.below(i + 1)]);
    expect_same_bits(calibrate_samples(shuffled), found);
  }
}

TEST(RepeatedSamples, OneDetectionUnderTwoPosesIsStillFoundToBeWrong) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulatedSamples drawn = arm(6, seed, 0.1, 1);
    drawn.samples[0].b = drawn.samples[1].b;
    const SampleCalibration found = calibrate_samples(drawn.samples);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(found.residuals[i].wrong, i == 0) << seed << " " << i;
  }
}

TEST(RepeatedSamples, OfOnePoseAloneShowNothing) {
  const SimulatedSamples drawn = arm(6, 2);
  Random random(4);
  for (const std::size_t n : {3u, 5u, 6u, 8u, 20u})
    for (const bool noise : {false, true}) {
      std::vector<PoseSample> still(n, drawn.samples[0]);
      if (noise)
        for (PoseSample& sample : still)
          sample.b = to_dual_quaternion(testing::noisy(to_pose(sample.b), 5e-3, 2e-3, random));
      const SampleCalibration found = calibrate_samples(still);
      const Calibration& calibration = found.calibration;
      EXPECT_EQ(calibration.verdict, Verdict::incomplete) << n << calibration.reason;
      EXPECT_THAT(calibration.observability.observable, ::testing::Each(false)) << n;
      ASSERT_EQ(calibration.findings.size(), 1u) << n;
      EXPECT_EQ(calibration.findings[0].code, "too_little_motion");
      EXPECT_THAT(calibration.findings[0].message, ::testing::StartsWith("Only 1 different pose"));
      EXPECT_EQ(calibration.counts.outliers, 0u) << n;
      EXPECT_EQ(found.different, 1u);
    }
}

}  // namespace
}  // namespace egocal::test_samples_repeats
