// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What every pose goes through many times is written for speed; it must say the same as the plain way.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "../support/random_motion.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/problem/blocks.hpp"
#include "motions/motions_between.hpp"
#include "motions/motions_to_one.hpp"
#include "problem/motion_square.hpp"
#include "robust/disagreements.hpp"
#include "robust/residual_limit.hpp"
#include "statistics/order_statistic.hpp"
#include "statistics/select.hpp"

namespace egocal::test_hot_paths {
namespace {

using testing::displacement;
using testing::Random;

DualQuaternion random_pose(Random& random) {
  const DualQuaternion pose = displacement(random.normal3(2), random.normal3(100));
  return random.below(2) == 0 ? pose : -pose;
}

TEST(MotionsBetween, HasTheBitsOfTheMotionOfEachSensor) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Instant from, to;
    from.a = random_pose(random);
    from.b = random_pose(random);
    to.a = random_pose(random);
    to.b = i % 10 == 0 ? from.b : random_pose(random);
    if (i % 7 == 0) to.a = from.a * DualQuaternion{QuaternionVector(0, 1, 0, 0)};  // a half turn
    const detail::MotionsOfBoth motions = detail::motions_between(from, to);
    EXPECT_EQ(motions.a.vec(), motion_between(from.a, to.a).vec()) << i;
    EXPECT_EQ(motions.b.vec(), motion_between(from.b, to.b).vec()) << i;
  }
}

TEST(MotionsToOne, HaveTheBitsOfOneAtATime) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    Instant to;
    to.a = random_pose(random);
    to.b = random_pose(random);
    std::array<Instant, detail::MotionsToOne::count> from;
    std::array<const Instant*, detail::MotionsToOne::count> places;
    for (std::size_t k = 0; k < from.size(); ++k) {
      from[k].a = random_pose(random);
      from[k].b = i % 10 == 0 ? to.b : random_pose(random);
      places[k] = &from[k];
    }
    if (i % 7 == 0) from[1].a = to.a * DualQuaternion{QuaternionVector(0, 1, 0, 0)};  // a half turn
    for (const bool in_pairs : {false, true}) {
      detail::MotionsToOne found;
      detail::set_motions_to_one(places, to, found, in_pairs);
      for (std::size_t k = 0; k < from.size(); ++k) {
        if (!found.plain[k]) {
          EXPECT_TRUE(i % 7 == 0 && k == 1) << i;
          continue;
        }
        const detail::MotionsOfBoth motions = detail::motions_between(from[k], to);
        EXPECT_EQ(found.least_scalar[k], std::min(motions.a.real[0], motions.b.real[0])) << i;
        Matrix8d sum = Matrix8d::Zero();
        found.squares[k].add_to(sum);
        Statistics expected;
        expected.add(motions.a, motions.b);
        EXPECT_EQ(sum, expected.dual_rows) << i;
      }
    }
  }
}

TEST(MotionSquare, IsAddedToTheSameBitsInWideLanesAndInPairs) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const detail::MotionSquare square(random_pose(random), random_pose(random));
    const detail::SquareWeights weights{random.uniform(), random.uniform(0, 10), i % 3 == 0};
    std::array<Matrix8d, 3> wide, pairs;
    for (std::size_t k = 0; k < wide.size(); ++k) {
      wide[k] = Matrix8d::Constant(random.normal());
      if (i % 2 == 0) square.add_to(wide[k], random.uniform());
      pairs[k] = wide[k];
    }
    const Matrix8d before = wide[1];
    square.add_to(wide[0], 0.3);
    square.add_to(pairs[0], 0.3, true);
    EXPECT_EQ(wide[0], pairs[0]) << i;
    square.add_weighted_to(std::array{&wide[0], &wide[1], &wide[2]}, weights);
    square.add_weighted_to(std::array{&pairs[0], &pairs[1], &pairs[2]}, weights, true);
    for (std::size_t k = 0; k < wide.size(); ++k) EXPECT_EQ(wide[k], pairs[k]) << i;
    Matrix8d plain = Matrix8d::Zero(), expected = Matrix8d::Zero();
    square.add_to(plain);
    if (!weights.rotation_only) expected = weights.translation * plain;
    expected.topLeftCorner<4, 4>() += weights.rotation * plain.bottomRightCorner<4, 4>();
    EXPECT_EQ(wide[1], Matrix8d(before + expected)) << i;
  }
}

TEST(BlockStatistics, OfSquaresHaveTheBitsOfThoseOfPairs) {
  Random random(7);
  BlockStatistics of_pairs, of_squares;
  for (int i = 0; i < 300; ++i) {
    const MotionPair pair{canonical_sign(random_pose(random)), canonical_sign(random_pose(random)), 0, 1, 1};
    of_pairs.add(pair);
    of_squares.add(detail::MotionSquare(pair.a, pair.b));
  }
  const auto &expected = of_pairs.state().blocks, &found = of_squares.state().blocks;
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].statistics.dual_rows, expected[k].statistics.dual_rows) << k;
    EXPECT_EQ(found[k].statistics.weight, expected[k].statistics.weight) << k;
    EXPECT_EQ(found[k].statistics.count, expected[k].statistics.count) << k;
  }
}

TEST(Disagreements, HaveTheBitsOfOneAtATime) {
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    Instant to;
    to.a = random_pose(random);
    to.b = random_pose(random);
    std::array<Instant, detail::MotionsToOne::count> from;
    std::array<const Instant*, detail::MotionsToOne::count> places;
    std::array<Agreement, detail::MotionsToOne::count> agreements;
    std::array<const Agreement*, detail::MotionsToOne::count> judges;
    for (std::size_t k = 0; k < from.size(); ++k) {
      const bool rests = i % 10 == 0 && k == 2;
      from[k].a = rests ? to.a : random_pose(random);
      from[k].b = rests ? to.b : random_pose(random);
      places[k] = &from[k];
      agreements[k] = {displacement(random.normal3(1), random.normal3(1)),
                       {random.log_uniform(1e-6, 1), random.log_uniform(1e-8, 1)}};
      judges[k] = &agreements[k];
    }
    const Balance balance{random.log_uniform(0.01, 100), random.log_uniform(0.01, 100)};
    for (const bool in_pairs : {false, true}) {
      detail::MotionsToOne motions;
      detail::set_motions_to_one(places, to, motions, in_pairs);
      const auto found = detail::disagreements(motions, judges, balance, {}, in_pairs);
      for (std::size_t k = 0; k < from.size(); ++k) {
        const detail::MotionsOfBoth both = detail::motions_between(from[k], to);
        EXPECT_EQ(found[k], detail::disagreement(both.a, both.b, balance, agreements[k], {})) << i;
      }
    }
  }
}

TEST(Selected, IsTheValueAtThePlaceOfSortedValues) {
  Random random(9);
  for (int i = 0; i < 400; ++i) {
    std::vector<double> values(1 + random.below(i % 3 == 0 ? 20 : 1000));
    for (double& value : values)  // sorted one way or the other, few different ones, any
      value = i % 4 == 0   ? static_cast<double>(&value - values.data())
              : i % 4 == 1 ? 1e6 - static_cast<double>(&value - values.data())
              : i % 4 == 2 ? std::floor(random.uniform(0, 4))
                           : std::exp(5 * random.normal());
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t place :
         {std::size_t{0}, values.size() / 4, values.size() / 2, values.size() - 1}) {
      std::vector<double> room(2 * values.size());
      EXPECT_EQ(detail::selected(values, place, room), sorted[place]) << i;
      std::copy(values.begin(), values.end(), room.begin());
      EXPECT_EQ(detail::selected(std::span(room).first(values.size()), place, room), sorted[place]) << i;
    }
  }
}

TEST(WeightedQuantile, IsWhatSortingFinds) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::pair<double, double>> values(i % 4 == 0 ? 1 + random.below(100)
                                                             : 256 + random.below(800));
    for (auto& [value, weight] : values) {  // heavy-tailed, few different ones; weights that grow with them
      value = i % 5 == 1 ? std::floor(random.uniform(0, 4)) : std::exp(3 * random.normal());
      weight = i % 3 == 0 ? 1 : i % 3 == 1 ? random.uniform() : value;
    }
    std::vector<std::pair<double, double>> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    double total = 0;
    for (const auto& entry : sorted) total += entry.second;
    for (const double part : {0.0, 0.05, 1.0 / 3, 0.5, 0.9, 1.0}) {
      double sum = 0;
      const auto expected = std::find_if(sorted.begin(), sorted.end(), [&](const auto& entry) {
        return (sum += entry.second) >= part * total;
      });
      ASSERT_NE(expected, sorted.end());
      EXPECT_EQ(detail::weighted_quantile(values, part), expected->first) << i;
    }
  }
}

TEST(OrderStatistic, IsTheValueAtThePlaceOfSortedValues) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    std::vector<double> values(1 + random.below(i % 3 == 0 ? 100 : 1024));
    for (double& value : values)  // sorted, heavy-tailed, few different ones
      value = i % 5 == 0   ? static_cast<double>(&value - values.data())
              : i % 5 == 1 ? std::floor(random.uniform(0, 4))
                           : std::exp(5 * random.normal());
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t place :
         {std::size_t{0}, values.size() / 4, values.size() / 2, values.size() - 1}) {
      EXPECT_EQ(detail::order_statistic(values, place), sorted[place]) << i;
      const double wanted = sorted[place] * random.uniform(0.5, 1.5);  // expected near there, or wrongly
      EXPECT_EQ(detail::order_statistic(values, place, {0.8 * wanted, 1.2 * wanted}), sorted[place]) << i;
    }
  }
}

TEST(Disagreement, OfAMotionIsThatOfItsStatistics) {
  Random random(3);
  const DualQuaternion T = displacement({0.3, -1.2, 2}, {0.5, -0.2, 1});
  for (const MotionPair& pair :
       testing::random_pairs(T, {.pairs = 200, .noise = 0.05, .flip_signs = true}, random)) {
    Statistics part;
    part.add(pair);
    const Balance balance{random.log_uniform(0.01, 100), random.log_uniform(0.01, 100)};
    const Agreement agreement{T, {random.log_uniform(1e-6, 1), random.log_uniform(1e-6, 1)}};
    const double expected = disagreement(part, balance, agreement);
    EXPECT_NEAR(detail::disagreement(pair.a, pair.b, balance, agreement, {}), expected, 1e-9 * expected);
    EXPECT_GT(expected, 0);
  }
}

}  // namespace
}  // namespace egocal::test_hot_paths
