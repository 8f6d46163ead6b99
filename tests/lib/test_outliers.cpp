// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Drives with a fifth of the poses of one stream grossly wrong: the error must stay near that of a drive in
// which those poses are simply not there. No method can do better than that.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "../support/corruption.hpp"
#include "../support/paths.hpp"
#include "../support/real_drives.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_outliers {
namespace {

using testing::corrupted;
using testing::Corruption;
using testing::corruptions;
using testing::Streams;

/// All but the poses that are missing, with which they are compared.
constexpr std::span wrong = std::span(corruptions).subspan<1>();
static_assert(corruptions[0] == Corruption::missing);

ExtrinsicError error_of(const Streams& data, const Trajectory& a, const Trajectory& b) {
  const Answer answer = solve(pair_motions(data.options, a, b).drive.problem(), Method::dual);
  EXPECT_EQ(answer.certificate.optimality, Optimality::certified);
  const ExtrinsicError error = extrinsic_error(data.T, answer.T_a_b);
  return {.translation = error.translation * 100, .rotation = error.rotation * 180 / std::numbers::pi};
}

/// Errors [cm, deg] with the corruption in a, then in b.
std::array<ExtrinsicError, 2> errors_of(const Streams& data, Corruption corruption, std::uint64_t seed) {
  return {error_of(data, corrupted(data.a, corruption, seed), data.b),
          error_of(data, data.a, corrupted(data.b, corruption, seed))};
}

Streams simulated(Terrain terrain, std::uint64_t seed) {
  return testing::simulated_drive({.terrain = terrain, .relative_noise = 0.01, .seed = seed});
}

/// Each error is a draw of its own, so medians over seeds are compared, and a single one only roughly.
TEST(Outliers, AFifthOfThePosesWrongAtMostDoublesTheError) {
  constexpr std::uint64_t seeds = 3;
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    const auto median_and_worst = [&](auto error) {
      std::vector<double> values;
      for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        for (const double value : error(seed)) values.push_back(value);
      std::sort(values.begin(), values.end());
      return std::pair{values[values.size() / 2], values.back()};
    };
    const auto [clean, worst_clean] = median_and_worst([&](std::uint64_t seed) {
      const Streams data = simulated(terrain, seed);
      const double one = error_of(data, data.a, data.b).rotation;
      return std::array{one, one};
    });
    const auto [missing, worst_missing] = median_and_worst([&](std::uint64_t seed) {
      const auto errors = errors_of(simulated(terrain, seed), Corruption::missing, seed);
      return std::array{errors[0].rotation, errors[1].rotation};
    });
    for (const Corruption corruption : wrong) {
      const auto [median, worst] = median_and_worst([&](std::uint64_t seed) {
        const auto errors = errors_of(simulated(terrain, seed), corruption, seed);
        return std::array{errors[0].rotation, errors[1].rotation};
      });
      EXPECT_LE(median, 2 * std::max(clean, missing)) << to_string(corruption);
      EXPECT_LE(worst, 2 * std::max(worst_clean, worst_missing)) << to_string(corruption);
    }
  }
}

class RealOutliers : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::have_real_drives())
      GTEST_SKIP() << "the folder of real drives " << paths::data_dir() << " is not here";
  }
  /// At most twice the larger of the errors of the clean run and of one in which a fifth is missing.
  static void check(const Streams& data) {
    const ExtrinsicError clean = error_of(data, data.a, data.b);
    const auto missing = errors_of(data, Corruption::missing, 7);
    const double degrees = 2 * std::max({clean.rotation, missing[0].rotation, missing[1].rotation});
    const double centimetres =
        2 * std::max({clean.translation, missing[0].translation, missing[1].translation});
    for (const Corruption corruption : wrong)
      for (const ExtrinsicError& error : errors_of(data, corruption, 7)) {
        EXPECT_LE(error.rotation, degrees) << to_string(corruption);
        EXPECT_LE(error.translation, centimetres) << to_string(corruption);
      }
  }
};

TEST_F(RealOutliers, Kitti) {
  check(testing::kitti("07"));
  check(testing::planar(testing::kitti("07")));
}

/// Where a stretch of exchanged axes hides: on straight roads only the few turns of a car tell.
TEST_F(RealOutliers, TwoAxesExchangedOnALongDrive) {
  const Streams data = testing::kitti("05");
  const double clean = error_of(data, data.a, data.b).rotation;
  for (const ExtrinsicError& error : errors_of(data, Corruption::mirrored_axes, 7))
    EXPECT_LE(error.rotation, 2 * clean);
}

/// An arm whose best motions take two seconds, with noise that hides what happens from one pose to the next.
TEST_F(RealOutliers, RobotArm) {
  const Streams data = testing::robot_arm();
  double missing = 0;
  for (const std::uint64_t seed : {7u, 8u, 9u})
    for (const ExtrinsicError& error : errors_of(data, Corruption::missing, seed))
      missing = std::max(missing, error.rotation);
  for (const std::uint64_t seed : {7u, 8u, 9u})
    for (const Corruption corruption :
         {Corruption::lasting_jumps, Corruption::frozen_once, Corruption::frozen_often})
      for (const ExtrinsicError& error : errors_of(data, corruption, seed))
        EXPECT_LE(error.rotation, 2 * missing) << to_string(corruption) << ", seed " << seed;
}

TEST_F(RealOutliers, HandheldAtDifferentRates) {
  check(testing::euroc());
}

}  // namespace
}  // namespace egocal::test_outliers
