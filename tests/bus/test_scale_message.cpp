// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Scales on the wire: what is refused, and that a listener believes its own solution alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/scale_problem.hpp"
#include "egocal/bus/scale.hpp"

namespace egocal::bus::test_scale_message {
namespace {

constexpr std::int64_t begin_us = 1'600'000'000'000'000;

ScaleProblem problem(double scale = 0.37) {
  return testing::scale_problem_of_b(scale);
}

scale_problem_t question(const ScaleProblem& problem, std::int64_t seq = 5) {
  scale_problem_t message = to_message(problem);
  message.utime = message.session = begin_us;
  message.seq = seq;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  message.scale = 0.37;
  return message;
}

scale_t answer(const ScaleProblem& problem, std::int64_t seq = 5) {
  scale_t message = to_message(solve_scale(problem.blocks, problem.options), question(problem, seq));
  message.solver = "egocal-global";
  return message;
}

TEST(ScaleMessage, ComesBackToTheBit) {
  const ScaleProblem sent = problem();
  const Checked<ScaleProblem> received = to_scale_problem(question(sent));
  ASSERT_TRUE(received) << received.reason;
  const ScaleSolution here = solve_scale(sent.blocks, sent.options);
  const ScaleSolution there = solve_scale(received.value->blocks, received.value->options);
  EXPECT_EQ(there.scale, here.scale);
  EXPECT_EQ(there.stddev, here.stddev);
  EXPECT_EQ(there.lower_bound, here.lower_bound);
  EXPECT_TRUE(there.certified);
}

TEST(ScaleMessage, WhatCannotBeIsRefused) {
  const ScaleProblem good = problem();
  const auto refused = [&](const auto& change) {
    scale_problem_t message = question(good);
    change(message);
    return !to_scale_problem(message);
  };
  EXPECT_FALSE(refused([](scale_problem_t&) {}));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.side = 2; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.noise = -1; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.least = 0; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.most = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.scale = -1; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.doubt = -1e-9; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.doubt = std::nan(""); }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.weight_translation = 0; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.blocks[0].weight = 0; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.blocks[0].rotation[0] = std::nan(""); }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.blocks[0].square_a = -1; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.blocks[0].coupling_b[3] = 1e9; }));
  EXPECT_TRUE(refused([](scale_problem_t& m) { m.sensor_a = "a b"; }));
  const auto contradicts = [&](const auto& change) {
    scale_t message = answer(good);
    change(message);
    return !to_scale(message);
  };
  EXPECT_FALSE(contradicts([](scale_t&) {}));
  EXPECT_TRUE(contradicts([](scale_t& m) { m.scale = 0; }));
  EXPECT_TRUE(contradicts([](scale_t& m) { m.stddev = std::nan(""); }));
  EXPECT_TRUE(contradicts([](scale_t& m) { m.lower_bound = m.cost + 1; }));
  EXPECT_TRUE(contradicts([](scale_t& m) { m.at_limit = 1; }));
  EXPECT_TRUE(contradicts([](scale_t& m) { m.least_scale = 2 * m.scale; }));
}

TEST(ScaleMessage, AListenerBelievesItsOwnSolutionAlone) {
  const ScaleProblem good = problem();
  ScaleCheck check;
  EXPECT_EQ(check.take(answer(good)), "");
  const CheckedScale* early = check.find("lidar", "camera", begin_us);
  ASSERT_TRUE(early);
  EXPECT_FALSE(early->verified);
  EXPECT_FALSE(early->solution.certified) << "its problem has not been received";
  EXPECT_FALSE(check.in_force("lidar", "camera", begin_us));

  EXPECT_EQ(check.take(question(good)), "");
  const CheckedScale* checked = check.find("lidar", "camera", begin_us);
  ASSERT_TRUE(checked);
  EXPECT_TRUE(checked->verified);
  EXPECT_TRUE(checked->solution.certified);
  EXPECT_EQ(checked->sensor, "camera");
  EXPECT_NEAR(checked->solution.scale, 0.37, 0.01);
  EXPECT_EQ(check.in_force("lidar", "camera", begin_us), 0.37);
  EXPECT_FALSE(check.find("lidar", "camera", begin_us + 1)) << "another session";

  scale_t lie = answer(good);
  lie.scale = lie.least_scale = lie.most_scale = 0.38;
  EXPECT_NE(check.take(lie), "");
  lie = answer(good);
  lie.stddev = 1e-12;  // what is not checked is not taken over
  EXPECT_EQ(check.take(lie), "");
  EXPECT_GT(check.find("lidar", "camera", begin_us)->solution.stddev, 1e-6);
}

// 256 of them filled it for ever
TEST(ScaleMessage, InventedPairsDisplaceNoneThatIsHeardAgain) {
  const ScaleProblem good = problem();
  ScaleCheck check;
  scale_problem_t invented = question(good);
  for (std::size_t i = 0; i < 3 * max_pairs; ++i) {
    invented.sensor_b = "b" + std::to_string(i);
    ASSERT_EQ(check.take(invented), "");
  }
  EXPECT_EQ(check.take(question(good)), "");
  EXPECT_EQ(check.take(answer(good)), "");
  for (std::size_t i = 0; i < 3 * max_pairs; ++i) {
    if (i % 100 == 0) {
      EXPECT_EQ(check.take(question(good)), "");
    }
    invented.sensor_b = "c" + std::to_string(i);
    ASSERT_EQ(check.take(invented), "");
  }
  const CheckedScale* const checked = check.find("lidar", "camera", begin_us);
  ASSERT_TRUE(checked);
  EXPECT_TRUE(checked->verified);
  EXPECT_FALSE(check.in_force("lidar", "b0", begin_us)) << "memory is bounded";
}

}  // namespace
}  // namespace egocal::bus::test_scale_message
