// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The standard deviations that are compared with a goal.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/simulated_drive.hpp"
#include "diagnosis/goal_spread.hpp"

namespace egocal {
namespace {

Answered answered_after(Terrain terrain, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 401;
  options.relative_noise = 0.02;
  options.seed = seed;
  const testing::Streams streams = testing::simulated_drive(options);
  const Problem problem = pair_motions({}, streams.a, streams.b).drive.problem();
  const Answer answer = solve(problem, Method::dual);
  Answered answered;
  answered.T_a_b = answer.T_a_b;
  answered.observability = answer.observability;
  answered.problem = problem;
  return answered;
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
}  // namespace egocal
