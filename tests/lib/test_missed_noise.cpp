// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What a spread over blocks of instants misses, and that short drives are not believed for it.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/simulated_drive.hpp"
#include "egocal/online/answer.hpp"
#include "estimation/missed_noise.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_missed_noise {
namespace {

TEST(MissedNoise, LongMotionsHideTheNoiseOfTheirSteps) {
  // s / (2 L) of the variance, where motions are much longer than blocks
  EXPECT_NEAR(detail::missed_noise({64}, {1}, 1e6, 4), std::sqrt(64.0 / 8), 0.1);
  EXPECT_EQ(detail::missed_noise({64}, {1}, 1e6, 32), 1);
  EXPECT_EQ(detail::missed_noise({64}, {1}, 0, 4), 1);
}

TEST(MissedNoise, ShortDrivesWithNoiseOnMotionsAreCovered) {
  int seen = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const testing::Streams streams =
        testing::simulated_drive({.poses = 101, .relative_noise = 0.01, .seed = seed});
    const Answer answer = solve(pair_motions({}, streams.a, streams.b).drive.problem(), Method::dual);
    const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
    for (std::size_t i = 0; i < 6; ++i) {
      if (!answer.observability.observable[i] || !std::isfinite(answer.observability.stddev[i])) continue;
      ++seen;
      covered += std::abs(error[static_cast<Eigen::Index>(i)]) <= 1.96 * answer.observability.stddev[i];
    }
  }
  EXPECT_GE(covered, 0.92 * seen) << covered << " of " << seen;
}

}  // namespace
}  // namespace egocal::test_missed_noise
