// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Still poses whose rotations differ by half turns: these commute, so several X fit them, and positions
// decide.
#include <gtest/gtest.h>

#include "../support/arm_samples.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::test_samples_half_turns {
namespace {

using testing::Random;
using testing::SimulatedSamples;

constexpr double degree = std::numbers::pi / 180;

enum class Turns {
  half,     ///< none, and half a turn about x, y or z
  quarter,  ///< none to three quarters of a turn about two of x, y and z
};

Rotation turn_of(Turns turns, std::size_t i, Random& random) {
  if (turns == Turns::half) {
    const auto axis = static_cast<int>(i % 4);
    if (axis == 3) return Rotation::Identity();
    return rotation_exp(std::numbers::pi * Eigen::Vector3d::Unit(axis));
  }
  const auto quarters = [&] {
    const auto count = static_cast<double>(random.below(4));
    const auto axis = static_cast<int>(random.below(3));
    return rotation_exp(count * std::numbers::pi / 2 * Eigen::Vector3d::Unit(axis));
  };
  const Rotation first = quarters();
  return first * quarters();
}

SimulatedSamples arm(Turns turns, std::size_t n, std::uint64_t seed) {
  Random random(seed);
  const auto anywhere = [&](double size) -> Pose {
    const Eigen::Vector3d turn = random.normal3(), shift = random.normal3(size);
    return {rotation_exp(turn), shift};
  };
  const Pose X = anywhere(0.06), Y = anywhere(0.6);
  SimulatedSamples drawn{to_dual_quaternion(X), to_dual_quaternion(Y), {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    const Rotation turn = turn_of(turns, i, random);
    const Pose hand{turn, random.normal3(0.2)};
    const Pose target = testing::noisy(inverse(inverse(Y) * hand * X), 0.2 * degree, 1e-3, random);
    drawn.samples.push_back({to_dual_quaternion(hand), to_dual_quaternion(inverse(target))});
  }
  return drawn;
}

void expect_right(const SimulatedSamples& drawn, const SampleOptions& options = {}) {
  const SampleCalibration found = calibrate_samples(drawn.samples, options);
  EXPECT_LT(extrinsic_error(drawn.X, to_dual_quaternion(found.calibration.T_a_b)).rotation, 3 * degree);
  EXPECT_NE(found.calibration.verdict, Verdict::contradictory) << found.calibration.reason;
  EXPECT_EQ(found.calibration.counts.outliers, 0u);
}

TEST(HalfTurns, AboutThreeAxesLeaveFourAnswersOfWhichThePositionsTakeOne) {
  for (const std::size_t n : {4u, 5u, 6u, 8u, 12u, 16u, 24u, 40u})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(std::to_string(n) + " samples, seed " + std::to_string(seed));
      expect_right(arm(Turns::half, n, seed));
    }
}

TEST(HalfTurns, AreDecidedAlsoWhereNoSampleIsRejected) {
  SampleOptions all;
  all.robust = false;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    expect_right(arm(Turns::half, 20, seed), all);
  }
}

TEST(HalfTurns, AmongQuarterTurnsOfFewSamplesAreDecided) {
  for (const std::size_t n : {4u, 5u})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const SimulatedSamples drawn = arm(Turns::quarter, n, seed);
      const SampleCalibration found = calibrate_samples(drawn.samples);
      EXPECT_NE(found.calibration.verdict, Verdict::contradictory) << n << " samples, seed " << seed;
    }
}

}  // namespace
}  // namespace egocal::test_samples_half_turns
