// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which rows of two lists of still poses belong together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../support/arm_samples.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/match_samples.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::test_match_samples {
namespace {

using testing::SimulatedSamples;

SimulatedSamples arm(std::size_t samples, std::uint64_t seed) {
  testing::ArmSamples what;
  what.samples = samples;
  what.rotation_noise = what.position_noise = 0;
  testing::Random random(seed);
  return testing::simulate_arm(what, random);
}

Trajectory at(const std::vector<double>& seconds) {
  Trajectory trajectory;
  for (const double t : seconds) trajectory.push_back({static_cast<std::int64_t>(1e6 * t), DualQuaternion{}});
  return trajectory;
}

TEST(MatchSamples, RowsBelongTogetherByNearestStampOrElseByOrder) {
  const MatchedSamples near = match_samples(at({0, 1, 2, 3, 4}), at({0.02, 1.01, 3.03, 4.02}));
  EXPECT_TRUE(near.by_stamp);
  EXPECT_THAT(near.rows_a, ::testing::ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(near.rows_b, ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(near.without_partner, 1u);
  const MatchedSamples order = match_samples(at({0, 1, 2, 3}), at({100, 107, 109, 120}));
  EXPECT_FALSE(order.by_stamp);
  EXPECT_THAT(order.rows_b, ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_THROW(match_samples(at({0, 1, 2, 3, 4}), at({100, 107, 109, 120})), Error);
  EXPECT_THROW(match_samples({}, {}), Error);
}

/// A row: its stamp, and the sample that it is of.
struct Stamped {
  double seconds = 0;
  int number = 0;
};
Trajectory poses_of(const SimulatedSamples& drawn, Side side, const std::vector<Stamped>& rows) {
  Trajectory poses;
  for (const Stamped& row : rows) {
    const PoseSample& sample = drawn.samples[static_cast<std::size_t>(row.number)];
    poses.push_back({std::llround(1e6 * row.seconds), side == Side::a ? sample.a : sample.b});
  }
  return poses;
}

// Both lists were equally long, so all rows between the two that are missing were put together wrongly
TEST(MatchSamples, RowsThatLackAPartnerLeaveTheOthersToTheirStamps) {
  for (const double clock_b : {0.0, 0.2}) {  // [s]
    const SimulatedSamples drawn = arm(20, 3);
    std::vector<Stamped> a, b;
    for (int i = 0; i < 20; ++i) {
      if (i != 5) a.push_back({10.0 * i, i});
      if (i != 13) b.push_back({10.0 * i + clock_b, i});
    }
    const MatchedSamples matched = match_samples(poses_of(drawn, Side::a, a), poses_of(drawn, Side::b, b));
    EXPECT_TRUE(matched.by_stamp);
    EXPECT_EQ(matched.samples.size(), 18u);
    EXPECT_EQ(matched.without_partner, 2u);
    const SampleCalibration found = calibrate_samples(matched.samples);
    EXPECT_TRUE(std::none_of(found.residuals.begin(), found.residuals.end(),
                             [](const SampleResidual& residual) { return residual.wrong; }));
  }
}

// One list counts from 0, the other one from 1: nearly all stamps agree, and none belongs together
TEST(MatchSamples, CountersThatBeginElsewhereAreMatchedByRow) {
  for (const bool invert : {false, true}) {
    const SimulatedSamples drawn = arm(12, 4);
    std::vector<Stamped> a, b;
    for (int i = 0; i < 12; ++i) {
      a.push_back({1.0 * i, i});
      b.push_back({1.0 * i + 1, i});
    }
    Trajectory poses_b = poses_of(drawn, Side::b, b);
    if (invert) poses_b = reread(poses_b, {QuaternionOrder::wxyz, true, 1});
    EXPECT_FALSE(match_samples(poses_of(drawn, Side::a, a), poses_b).by_stamp);
  }
}

// Seven rows of sixteen have a partner by their stamps, and none by their place
TEST(MatchSamples, FewRowsThatBelongTogetherAreFoundByTheirStamps) {
  const SimulatedSamples drawn = arm(25, 5);
  std::vector<Stamped> a, b;
  for (int i = 0; i < 16; ++i) {
    a.push_back({10.0 * i, i});
    b.push_back({10.0 * (i + 9), i + 9});
  }
  const MatchedSamples matched = match_samples(poses_of(drawn, Side::a, a), poses_of(drawn, Side::b, b));
  EXPECT_TRUE(matched.by_stamp);
  EXPECT_EQ(matched.samples.size(), 7u);
}

}  // namespace
}  // namespace egocal::test_match_samples
