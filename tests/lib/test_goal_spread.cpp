// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The standard deviations that are compared with a goal, and when it is reached.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../support/simulated_drive.hpp"
#include "diagnosis/goal/goal.hpp"
#include "diagnosis/goal/goal_spread.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_goal_spread {
namespace {

Answered answered_at(const testing::Streams& streams) {
  const MotionPairing drive = pair_motions({}, streams.a, streams.b).drive;
  Answered answered;
  answered.problem = drive.problem();
  const Answer answer = solve(answered.problem, Method::dual);
  answered.T_a_b = answer.T_a_b;
  answered.observability = answer.observability;
  answered.stride = drive.choice().stride;
  answered.seconds = 1e-6 * static_cast<double>(streams.a.back().time_us - streams.a.front().time_us);
  return answered;
}

SimulationOptions drive_of(Terrain terrain, std::uint64_t seed, int poses) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = poses;
  options.relative_noise = 0.02;
  options.seed = seed;
  return options;
}

Answered answered_after(Terrain terrain, std::uint64_t seed, int poses = 401) {
  return answered_at(testing::simulated_drive(drive_of(terrain, seed, poses)));
}

double scatter(const std::vector<double>& values) {
  double mean = 0, squares = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  for (const double x : values) squares += (x - mean) * (x - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(GoalSpread, ScattersLessThanTheReportedOnesAndIsAsLarge) {
  std::vector<double> differences, own;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Answered answered = answered_after(Terrain::free, seed);
    const std::array<double, 6> spread = detail::goal_spread(answered);
    // what all directions have in common (the path) cancels in the ratio of two of them
    own.push_back(std::log(answered.observability.stddev[3] / answered.observability.stddev[4]));
    differences.push_back(std::log(spread[3] / spread[4]));
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_GE(spread[k], answered.observability.stddev[k] / 1.51);
      EXPECT_LE(spread[k], answered.observability.stddev[k] * 1.51);
    }
  }
  EXPECT_LT(scatter(differences), 0.75 * scatter(own));
}

TEST(GoalSpread, OfPlainNoiseFallsSteadily) {
  // an error of 13 % is a factor of 1.5 in the time left
  std::array<std::vector<double>, 6> falls, reported_falls;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Answered half = answered_after(Terrain::free, seed, 401),
                   whole = answered_after(Terrain::free, seed, 801);
    const std::array<double, 6> before = detail::goal_spread(half), after = detail::goal_spread(whole);
    for (std::size_t k = 0; k < 6; ++k) {
      falls[k].push_back(std::log(after[k] / before[k]));
      reported_falls[k].push_back(std::log(whole.observability.stddev[k] / half.observability.stddev[k]));
    }
  }
  // those of the translations scatter with the path as well
  for (std::size_t k = 3; k < 6; ++k) {
    EXPECT_LT(scatter(falls[k]), 0.09) << k;
    EXPECT_LT(scatter(falls[k]), 0.5 * scatter(reported_falls[k])) << k;
  }
}

TEST(GoalSpread, OfWanderingNoiseIsNotTakenForPlain) {
  std::array<double, 6> squares{}, errors{};
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SimulationOptions options = drive_of(Terrain::free, seed, 601);
    options.random_walk = true;
    const testing::Streams streams = testing::simulated_drive(options);
    const Answered answered = answered_at(streams);
    const std::array<double, 6> spread = detail::goal_spread(answered);
    const auto error = detail::frame_a_difference(streams.T, answered.T_a_b);
    for (std::size_t k = 0; k < 6; ++k) {
      squares[k] += spread[k] * spread[k];
      errors[k] += std::pow(error[static_cast<Eigen::Index>(k)], 2);
    }
  }
  for (std::size_t k = 0; k < 6; ++k) EXPECT_GT(std::sqrt(squares[k] / errors[k]), 0.85) << k;
}

TEST(GoalSpread, AGoalIsReachedWhereAllDirectionsAreWithinItTogether) {
  const Answered answered = answered_after(Terrain::free, 1);
  const std::array<double, 6> spread = detail::goal_spread(answered);
  const GoalOptions each{*std::max_element(spread.begin() + 3, spread.end()),
                         *std::max_element(spread.begin(), spread.begin() + 3),
                         {}};
  const Goal one_by_one = detail::goal_of(answered, each);
  EXPECT_FALSE(one_by_one.reached);
  EXPECT_FALSE(one_by_one.missing.empty());
  ASSERT_TRUE(one_by_one.seconds_left);
  EXPECT_GT(*one_by_one.seconds_left, 0);
  EXPECT_LT(*one_by_one.seconds_left, answered.seconds);
  // six that are alike are within 1.96 goals together by 95 % where each is by 99.1 %: 2.63 of its standard
  // deviations
  EXPECT_TRUE(
      detail::goal_of(answered, {each.rotation * 2.64 / 1.96, each.translation * 2.64 / 1.96, {}}).reached);
}

/// Time left over that of the drive, of goals `times` smaller than what was just reached.
double time_left(const Answered& answered, double times) {
  const auto at = [&](double scale) { return detail::goal_of(answered, {0.01 * scale, 0.1 * scale, {}}); };
  double low = 1e-6, high = 1e6;
  for (int i = 0; i < 80; ++i) {
    const double middle = std::sqrt(low * high);
    (at(middle).reached ? high : low) = middle;
  }
  return at(low / times).seconds_left.value_or(NAN) / answered.seconds;
}

TEST(GoalSpread, TheTimeLeftSaysWhatIsUsuallyLeft) {
  const Answered answered = answered_after(Terrain::free, 1);
  EXPECT_NEAR(time_left(answered, std::sqrt(2.0)), 1, 0.05);
  // near the goal chance decides, so no time left is stated as nothing
  EXPECT_GT(time_left(answered, 1.0001), 0.1);
  EXPECT_LT(time_left(answered, 1.0001), 0.2);
  // four times as well takes 15 times as long where information grows steadily: it seldom does
  EXPECT_GT(time_left(answered, 4), 5);
  EXPECT_LT(time_left(answered, 4), 9);
}

TEST(GoalSpread, IsTheReportedOneWhereNothingElseIsKnown) {
  Answered answered = answered_after(Terrain::free, 1);
  answered.problem.blocks.resize(5);
  EXPECT_EQ(detail::goal_spread(answered), answered.observability.stddev);
}

TEST(GoalSpread, UnknownDirectionsStayUnknown) {
  const Answered answered = answered_after(Terrain::flat, 1);
  ASSERT_FALSE(answered.observability.observable[2]);
  EXPECT_TRUE(std::isinf(detail::goal_spread(answered)[2]));
}

}  // namespace
}  // namespace egocal::test_goal_spread
