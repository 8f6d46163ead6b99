// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/jackknife.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal::test_jackknife {
namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;
using testing::displacement;
using testing::Random;

Problem noisy_problem(std::uint64_t seed, Balance balance) {
  Random random(seed);
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  BlockStatistics blocks;
  for (const MotionPair& pair : testing::random_pairs(T, {.pairs = 300, .noise = 0.02}, random))
    blocks.add(pair);
  Problem problem;
  problem.balance = balance;
  problem.blocks = blocks.inliers();
  return problem;
}

/// The Newton step from q by the matrices themselves: sum the rest, T'ZT, T'Zq. Lengths are counted in
/// length_scale() of the whole, which the least squares multipliers depend on.
Vector6d step_by_matrices(const Problem& problem, const Statistics& rest, const DualQuaternion& q_metres) {
  const double length = detail::length_scale(cost_matrix(problem));
  const Matrix8d Q = detail::in_units_of(length, cost_matrix(rest, problem.balance));
  const DualQuaternion q = detail::in_units_of(length, q_metres);
  const Matrix8d Z = lagrangian_matrix(Q, least_squares_multipliers(Q, q));
  const Matrix86d T = detail::frame_a_basis(q);
  Vector6d step = -Matrix6d(T.transpose() * Z * T).fullPivLu().solve(Vector6d(T.transpose() * Z * q.vec()));
  step.head<3>() *= length;
  return step;
}

/// Blocks are projected once and subtracted as 6 x 6 forms; also where blocks touch, and a last one with a
/// negative weight takes off what is in two of them.
TEST(Jackknife, LeavingOutABlockIsANewtonStepOnTheRest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const bool touching : {false, true}) {
      Problem problem = noisy_problem(seed, {1, seed % 2 == 0 ? 0.01 : 3});
      if (touching) {
        Statistics shared = problem.blocks[3];
        problem.blocks[4] += shared;
        shared.dual_rows *= -1;
        shared.weight *= -1;
        problem.blocks.push_back(shared);
      }
      const DualQuaternion q = solve(problem, Method::dual).T_a_b;
      const std::vector<Vector6d> steps = leave_out_differences(problem, cost_matrix(problem), q);
      ASSERT_EQ(steps.size(), problem.blocks.size() - (touching ? 1 : 0));
      for (std::size_t i = 0; i < steps.size(); ++i) {
        Statistics rest;
        for (std::size_t k = 0; k < problem.blocks.size(); ++k)
          if (k != i) rest += problem.blocks[k];
        const Vector6d expected = step_by_matrices(problem, rest, q);
        EXPECT_LT((steps[i] - expected).norm(), 1e-8 * expected.norm()) << seed << " block " << i;
      }
    }
}

/// 24 blocks of 10 motions, of which the last ones turn about all axes and the others drive straight on.
Problem turning_at_the_end(int turning_blocks, std::uint64_t seed) {
  Random random(seed);
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  Problem problem;
  problem.balance = {1, 0.1};
  for (int block = 0; block < 24; ++block) {
    Statistics& statistics = problem.blocks.emplace_back();
    const bool turns = block >= 24 - turning_blocks;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d turn = random.normal3(turns ? 0.2 : 0), shift = {1, 0, 0};
      const DualQuaternion a = displacement(turn, shift), b = conjugate(T) * a * T;
      const DualQuaternion noise = displacement(random.normal3(0.002), random.normal3(0.01));
      statistics.add(a * noise, b);
    }
  }
  return problem;
}

/// Mean ratio of the reported standard deviations of the translation to those of the plain jack-knife.
double ratio_to_plain_jackknife(const Problem& problem) {
  const Matrix8d Q = cost_matrix(problem);
  const DualQuaternion q = solve(problem, Method::dual).T_a_b;
  const Observability known = assess_observability(problem, Q, q, ErrorCorrelation::independent);
  const std::vector<Vector6d> differences = leave_out_differences(problem, Q, q);
  const auto n = static_cast<double>(differences.size());
  Vector6d mean = Vector6d::Zero(), squares = Vector6d::Zero();
  for (const Vector6d& difference : differences) mean += difference / n;
  for (const Vector6d& difference : differences) squares += (difference - mean).cwiseAbs2();
  double ratio = 0;
  for (int i = 0; i < 3; ++i)
    ratio += known.stddev[static_cast<std::size_t>(i)] / std::sqrt(squares[i] * (n - 1) / n) / 3;
  return ratio;
}

/// The spread of two or three blocks says less of its own size than that of 24.
TEST(Jackknife, WhatFewBlocksHoldIsLessCertain) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double spread_out = ratio_to_plain_jackknife(turning_at_the_end(24, seed));
    EXPECT_GT(spread_out, 1) << seed;
    EXPECT_LT(spread_out, 1.15) << seed;
    const double concentrated = ratio_to_plain_jackknife(turning_at_the_end(3, seed));
    EXPECT_GT(concentrated, 1.2) << seed;
    EXPECT_LT(concentrated, 1.7) << seed;
  }
}

/// 24 blocks of 10 motions that turn about z, and in the last three also about x and y. turn: of a's axes.
Problem tilting_at_the_end(std::uint64_t seed, const DualQuaternion& turn) {
  Random random(seed);
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  Problem problem;
  problem.balance = {1, 0.1};
  for (int block = 0; block < 24; ++block) {
    Statistics& statistics = problem.blocks.emplace_back();
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d tilts = Eigen::Vector3d(block < 21 ? 0.01 : 0.2, block < 21 ? 0.02 : 0.2, 0.2);
      const DualQuaternion a = displacement(tilts.cwiseProduct(random.normal3(1)), {1, 0, 0});
      const DualQuaternion noise = displacement(random.normal3(0.002), random.normal3(0.01));
      statistics.add(conjugate(turn) * a * noise * turn, conjugate(T) * a * T);
    }
  }
  return problem;
}

/// Stride and balance are chosen by these sums: turned axes of a moved a real answer by 0.3 standard
/// deviations, as another balance was taken.
TEST(Jackknife, SettingsAreComparedBySumsThatDoNotDependOnTheAxes) {
  const auto sums = [](const Problem& problem) {
    const Matrix8d Q = cost_matrix(problem);
    const DualQuaternion q = solve(problem, Method::dual).T_a_b;
    const Observability known = assess_observability(problem, Q, q, ErrorCorrelation::independent);
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_TRUE(known.observable[i]);
      squares[i / 3] += known.stddev[i] * known.stddev[i];
    }
    return squares;
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto given = sums(tilting_at_the_end(seed, {}));
    for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.7, -0.4, 1.1), Eigen::Vector3d(-2, 0.9, 0.3)}) {
      const auto turned = sums(tilting_at_the_end(seed, displacement(turn, {0, 0, 0})));
      for (const std::size_t part : {0u, 1u})
        EXPECT_NEAR(turned[part], given[part], 1e-6 * given[part]) << seed << " part " << part;
    }
  }
}

/// Every motion lies in two of twelve blocks, and all turns in the same two: each of them holds nearly all
/// that is known of the translation.
Problem touching_with_one_turn(std::uint64_t seed) {
  Random random(seed);
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  std::vector<Statistics> between;
  for (int k = 0; k < 13; ++k) {
    Statistics& statistics = between.emplace_back();
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d turn = random.normal3(k == 6 ? 0.2 : 2e-3), shift = {1, 0, 0};
      const DualQuaternion a = displacement(turn, shift), b = conjugate(T) * a * T;
      const DualQuaternion noise = displacement(random.normal3(1e-6), random.normal3(0.01));
      statistics.add(a * noise, b);
    }
  }
  Problem problem;
  problem.balance = {1, 0.1};
  Statistics shared;
  for (std::size_t k = 0; k < 12; ++k) {
    problem.blocks.push_back(between[k]);
    problem.blocks.back() += between[k + 1];
    if (k > 0) shared += between[k];
  }
  shared.dual_rows *= -1;
  shared.weight *= -1;
  shared.count = 0;
  problem.blocks.push_back(shared);
  return problem;
}

/// Half of what a block holds must not stay behind where it is all that is known: the answer would not move.
TEST(Jackknife, ATouchingBlockThatHoldsAllIsOmittedAsAWhole) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Problem problem = touching_with_one_turn(seed);
    const Matrix8d Q = cost_matrix(problem);
    const DualQuaternion q = solve(problem, Method::dual).T_a_b;
    const Observability known = assess_observability(problem, Q, q, ErrorCorrelation::independent);
    Vector6d largest = Vector6d::Zero();
    for (const Vector6d& difference : leave_out_differences(problem, Q, q))
      largest = largest.cwiseMax(difference.cwiseAbs());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(std::isfinite(known.stddev[i])) << seed << " direction " << i;
      EXPECT_GT(known.stddev[i], 0.15 * largest[static_cast<Eigen::Index>(i)]) << seed << " direction " << i;
    }
  }
}

/// Where there is no noise the spreads of all settings are rounding, and the logarithm of rounding is a draw:
/// it must not decide, and single steps judge outliers best.
TEST(Jackknife, WithoutNoiseSingleStepsWithEqualWeightsAreChosen) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SimulationOptions options;
    options.terrain = Terrain::free;
    options.poses = 151;
    options.seed = seed;
    const testing::Streams s = testing::simulated_drive(options);
    const Choice choice = paired({}, s.a, s.b).choice();
    EXPECT_EQ(choice.stride, 1) << seed;
    EXPECT_EQ(choice.balance.translation, 1) << seed;
  }
}

/// Four blocks at once are the same as one after the other, in wide lanes and in pairs, also where a
/// curvature is not positive definite.
TEST(Jackknife, FourAtATimeAreOneAfterTheOther) {
  Random random(1);
  const Problem problem = noisy_problem(7, {1, 0.3});
  const DualQuaternion q = solve(problem, Method::dual).T_a_b;
  const detail::TangentSpace space(q, 1.25, detail::frame_a_basis(q), problem.balance);
  ASSERT_TRUE(space.starts_with_translations());
  for (std::size_t i = 0; i + 3 < problem.blocks.size(); ++i) {
    std::array<const Statistics*, 4> blocks;
    for (std::size_t k = 0; k < 4; ++k) blocks[k] = &problem.blocks[i + (k * 3) % 4];
    const detail::FourForms forms = space.forms(blocks), in_pairs = space.forms(blocks, true);
    EXPECT_EQ(forms.curvature, in_pairs.curvature);
    EXPECT_EQ(forms.gradient, in_pairs.gradient);
    detail::TangentForm all;
    for (std::size_t k = 0; k < 4; ++k) {
      const detail::TangentForm expected = space.form(*blocks[k]), one = forms.form(k);
      EXPECT_LT((one.curvature - expected.curvature).norm(), 1e-13 * expected.curvature.norm());
      EXPECT_LT((one.gradient - expected.gradient).norm(), 1e-13 * blocks[k]->dual_rows.norm());
      EXPECT_EQ(one.curvature, one.curvature.transpose());
      all += one;
    }
    detail::FourForms with_too_much = forms;
    detail::TangentForm too_much = all;
    too_much.curvature *= 2;
    with_too_much.set(i % 4, too_much);
    for (const detail::FourForms& parts : {forms, with_too_much}) {
      const detail::Fours<6> steps = detail::TangentSpace::newton_steps_without(all, parts);
      EXPECT_EQ(steps, detail::TangentSpace::newton_steps_without(all, parts, true));
      for (std::size_t k = 0; k < 4; ++k) {
        const Vector6d expected = detail::TangentSpace::newton_step(all - parts.form(k));
        for (std::size_t row = 0; row < 6; ++row)
          EXPECT_EQ(steps[row][k], expected[static_cast<Eigen::Index>(row)]);
      }
    }
    const detail::TriangleProducts products =
        detail::TriangleProducts::NullaryExpr([&] { return random.normal(); });
    const detail::Fours<6> sums = detail::sums_of_products(forms, products);
    EXPECT_EQ(sums, detail::sums_of_products(forms, products, true));
    for (std::size_t k = 0; k < 4; ++k) {
      const Matrix6d curvature = forms.form(k).curvature;
      Vector6d expected = Vector6d::Zero();
      for (int column = 0, entry = 0; column < 6; ++column)
        for (int row = 0; row <= column; ++row) expected += curvature(row, column) * products.col(entry++);
      for (std::size_t row = 0; row < 6; ++row)
        EXPECT_EQ(sums[row][k], std::max(0.0, expected[static_cast<Eigen::Index>(row)]));
    }
  }
}

struct Correlations {
  double of_neighbours = 0, sum = 0, scatter = 0, error = 0, scatter_of_sum = 0, error_of_sum = 0;
};

/// Mean of `drives` drives.
Correlations correlations_of(double memory, int blocks, int drives) {
  Correlations mean;
  double squares = 0, squares_of_sum = 0;
  Random random(11);
  for (int drive = 0; drive < drives; ++drive) {
    detail::Jackknife jackknife(blocks);
    Vector6d difference = Vector6d::Zero();
    for (int k = -20; k < blocks; ++k) {
      for (int i = 0; i < 5; ++i)  // the last direction never changes
        difference[i] = memory * difference[i] + std::pow(10.0, -i) * random.normal();
      if (k >= 0) jackknife.leave_out(1, difference, Vector6d::Ones(), difference);
    }
    EXPECT_DOUBLE_EQ(jackknife.mean_equal_blocks(2), blocks);
    const double found = jackknife.correlation_of_neighbours(0, blocks);
    mean.of_neighbours += found / drives;
    squares += found * found / drives;
    const double sum = jackknife.sum_of_correlations(blocks);
    mean.sum += sum / drives;
    squares_of_sum += sum * sum / drives;
    mean.error_of_sum = jackknife.error_of_sum(blocks);
    mean.error = jackknife.error_of_correlation(memory, blocks);
  }
  mean.scatter = std::sqrt(squares - mean.of_neighbours * mean.of_neighbours);
  mean.scatter_of_sum = std::sqrt(squares_of_sum - mean.sum * mean.sum);
  return mean;
}

TEST(Jackknife, SeesWhetherNeighboursShareTheirErrors) {
  for (const double memory : {-0.5, 0.0, 0.5, 0.7}) {
    EXPECT_NEAR(correlations_of(memory, 2000, 1).of_neighbours, memory, 0.03);
    EXPECT_NEAR(correlations_of(memory, 24, 100).of_neighbours, memory, 0.05);
  }
}

TEST(Jackknife, KnowsHowWellItKnowsACorrelation) {
  for (const double memory : {0.0, 0.5, 0.7})
    for (const int blocks : {12, 24}) {
      const Correlations found = correlations_of(memory, blocks, 200);
      EXPECT_NEAR(found.error, found.scatter, 0.25 * found.scatter) << memory << " " << blocks;
    }
}

/// Blocks that are few scatter less, as they are seen from their own mean.
TEST(Jackknife, KnowsHowWellItKnowsASumOfCorrelations) {
  for (const int blocks : {24, 48, 200}) {
    const Correlations found = correlations_of(0, blocks, 200);
    EXPECT_GT(found.error_of_sum, 0.9 * found.scatter_of_sum) << blocks;
    EXPECT_LT(found.error_of_sum, (1 + 10.0 / blocks) * found.scatter_of_sum) << blocks;
  }
}

/// Neighbours share half of their errors, and no error lasts; the first direction alone also has some that
/// do.
TEST(Jackknife, TellsWhatNeighboursShareFromWhatLasts) {
  Random random(5);
  double mean = 0, first = 0, second = 0;
  constexpr int drives = 200, blocks = 20;
  for (int drive = 0; drive < drives; ++drive) {
    detail::Jackknife jackknife(blocks);
    double lasting = 0;
    Vector6d last = Vector6d::Zero(), next;
    for (int k = -20; k < blocks; ++k) {
      for (int i = 0; i < 6; ++i) next[i] = random.normal();
      lasting = 0.8 * lasting + random.normal();
      Vector6d difference = last + next;
      difference[0] += lasting;
      if (k >= 0) jackknife.leave_out(1, difference, Vector6d::Ones(), difference);
      last = next;
    }
    mean += jackknife.correlation_of_neighbours(0.5, blocks) / drives;
    first += jackknife.correlation_in_direction(0, 0.5, blocks).value() / drives;
    second += jackknife.correlation_in_direction(1, 0.5, blocks).value() / drives;
  }
  EXPECT_LT(second, 0.05);  // nothing lasts
  EXPECT_GT(second, -0.3);  // their mean takes 3 r / m of what is shared as well, which stays
  EXPECT_GT(first, second + 0.15);
  EXPECT_NEAR(mean, (first + 5 * second) / 6, 0.05);
}

/// x, y and yaw of cars on flat ground.
TEST(Jackknife, CoversShortDrivesInThePlaneWhoseNoiseLasts) {
  SimulationOptions drive;
  drive.terrain = Terrain::flat;
  drive.poses = 21;
  drive.relative_noise = 0.01;
  drive.random_walk = true;
  PairingOptions options;
  options.mode = Mode::planar;
  const auto ground = [](const Pose& T) {
    return GroundPlane{T.rotation.conjugate() * Eigen::Vector3d::UnitZ(), -T.translation.z()};
  };
  options.plane_a = ground(testing::T_vehicle_a);
  options.plane_b = ground(testing::T_vehicle_b);
  int observable = 0, covered = 0;
  for (drive.seed = 1001; drive.seed <= 1040; ++drive.seed) {
    const testing::Streams streams = testing::simulated_drive(drive);
    const Answer answer = solve(pair_motions(options, streams.a, streams.b).drive.problem(), Method::dual);
    const Vector6d error = detail::frame_a_difference(streams.T, answer.T_a_b);
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!answer.observability.observable[k] || !std::isfinite(answer.observability.stddev[k])) continue;
      ++observable;
      covered += std::abs(error[i]) <= 1.96 * answer.observability.stddev[k];
    }
  }
  EXPECT_GE(covered, 0.93 * observable);  // 0.895 where the error of the correlation did not count
  EXPECT_GT(observable, 100);
}

TEST(Jackknife, AddsUpTheCorrelationsOfNearBlocks) {
  for (const double memory : {-0.5, 0.0, 0.5, 0.7}) {
    double expected = 0;
    for (std::size_t lag = 1; lag <= detail::Jackknife::most_lag; ++lag)
      expected += std::pow(memory, static_cast<double>(lag));
    EXPECT_NEAR(correlations_of(memory, 4000, 1).sum, expected, 0.1);
  }
  EXPECT_NEAR(correlations_of(0, 24, 100).sum, 0, 0.05);
  EXPECT_EQ(correlations_of(0.5, 3, 1).sum, 0);  // too few
}

/// A last block that takes off what is in two others is none of those that are omitted.
TEST(Jackknife, CountsNoBlockThatTakesOff) {
  const ObservabilityOptions options;
  const Problem all = noisy_problem(3, {1, 1});
  for (const std::size_t blocks : {options.least_blocks - 1, options.least_blocks}) {
    Problem problem = all;
    problem.blocks.resize(blocks);
    Statistics shared = all.blocks[blocks];
    problem.blocks[0] += shared;
    problem.blocks[1] += shared;
    shared.dual_rows *= -1;
    shared.weight *= -1;
    problem.blocks.push_back(shared);
    const Answer answer = solve(problem, Method::dual);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(std::isfinite(answer.observability.stddev[i]), blocks == options.least_blocks) << blocks;
  }
}

/// The sum of blocks is that of one after the other, whatever is kept in registers.
TEST(SumBlocks, HasTheBitsOfOneAfterTheOther) {
  const Problem problem = noisy_problem(8, {1, 1});
  Statistics expected;
  for (const Statistics& block : problem.blocks) expected += block;
  const Statistics sum = sum_blocks(problem.blocks);
  EXPECT_EQ(sum.dual_rows, expected.dual_rows);
  EXPECT_EQ(sum.weight, expected.weight);
  EXPECT_EQ(sum.count, expected.count);
}

}  // namespace
}  // namespace egocal::test_jackknife
