// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/robust/robust_statistics.hpp"
#include "robust/consensus_search.hpp"

namespace egocal::test_consensus {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
/// As different as a swapped axis makes it.
const DualQuaternion another = T_a_b * displacement({1.57, 0, 0}, {0, 0, 0});

Statistics of_one(const MotionPair& pair) {
  Statistics statistics;
  statistics.add(pair);
  return statistics;
}

/// Pairs in a random order of which `wrong` (a part) follow another extrinsic, all the same one.
std::vector<MotionPair> contradictory(double wrong, double noise, std::uint64_t seed,
                                      std::uint64_t count = 200) {
  Random random(seed);
  const auto good = random_pairs(T_a_b, {.pairs = count, .noise = noise}, random);
  const auto bad = random_pairs(another, {.pairs = count, .noise = noise}, random);
  std::vector<MotionPair> pairs;
  for (std::size_t i = 0; i < count; ++i) pairs.push_back(random.uniform() < wrong ? bad[i] : good[i]);
  return pairs;
}

std::vector<bool> wrong_ones(const std::vector<MotionPair>& pairs) {
  std::vector<bool> wrong;
  for (const MotionPair& pair : pairs)
    wrong.push_back((pair.a * T_a_b).vec().cwiseAbs().isApprox((T_a_b * pair.b).vec().cwiseAbs(), 0.2) ==
                    false);
  return wrong;
}

// What the search leaves out for it would have changed nothing: its scale is not smaller in either number.
TEST(Consensus, WhatIsCalledNoTighterIsNot) {
  int certain = 0, smaller = 0;
  for (const double noise : {0.0, 0.01, 0.3})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      std::vector<Statistics> parts;
      for (const MotionPair& pair : contradictory(0.35, noise, seed, 16 + seed))
        parts.push_back(of_one(pair));
      const ConsensusOptions options;
      const detail::ConsensusSearch search(Problem{}, parts, 1, options);
      std::vector<detail::ConsensusSearch::Candidate> fits;
      for (std::size_t first = 0; first + 4 <= parts.size(); first += 2) {
        std::vector<double> factors(parts.size(), 0.0);
        std::fill_n(factors.begin() + static_cast<std::ptrdiff_t>(first), 4, 1.0);
        fits.push_back(search.fit(factors));
      }
      for (const auto& fit : fits)
        for (const auto& other : fits) {
          const ResidualScale scale = search.scale_of(fit), than = search.scale_of(other);
          const bool is_smaller = scale.absolute < than.absolute || scale.relative < than.relative;
          smaller += is_smaller;
          if (!search.is_no_tighter(fit, than)) continue;
          ++certain;
          EXPECT_FALSE(is_smaller) << noise << ", seed " << seed;
        }
    }
  EXPECT_GT(smaller, 1000);
  EXPECT_GT(certain, 1000) << "it must save something";
}

TEST(Consensus, TheMajorityIsFoundEvenAgainstAMinorityThatAgrees) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto pairs = contradictory(0.35, 0.01, seed);
    std::vector<Statistics> parts;
    for (const MotionPair& pair : pairs) parts.push_back(of_one(pair));
    const std::optional<Consensus> consensus = find_consensus(Problem{}, parts);
    ASSERT_TRUE(consensus) << seed;
    const ExtrinsicError error = extrinsic_error(T_a_b, consensus->agreement.q);
    EXPECT_LT(error.rotation, 0.02) << seed;
    EXPECT_LT(error.translation, 0.15) << seed;
    // the same pairs that were made wrong, except for a few that are too small to tell
    const std::vector<bool> wrong = wrong_ones(pairs);
    int differ = 0;
    for (std::size_t i = 0; i < wrong.size(); ++i) differ += wrong[i] != consensus->outlier[i];
    EXPECT_LT(differ, 20) << seed;
  }
}

/// A wrong pose that was not recognised makes motions that are longer than all others together.
TEST(Consensus, AFewMotionsThatAreMuchLongerDoNotOutvoteTheOthers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const auto pairs = random_pairs(T_a_b, {.pairs = 640, .noise = 0.02}, random);
    const auto wrong = [&] {
      MotionPair pair = pairs.front();
      pair.a = displacement(random.normal3(0.5), random.normal3(12));
      pair.b = displacement(random.normal3(0.5), random.normal3(12));
      return pair;
    };
    std::vector<Statistics> parts(40);
    for (std::size_t i = 0; i < pairs.size(); ++i) parts[i / 16].add(pairs[i]);
    for (int i = 0; i < 2; ++i) parts[11].add(wrong());
    for (int i = 0; i < 3; ++i) parts.push_back(of_one(wrong()));
    const std::optional<Consensus> consensus = find_consensus(Problem{}, parts);
    ASSERT_TRUE(consensus) << seed;
    const ExtrinsicError error = extrinsic_error(T_a_b, consensus->agreement.q);
    // a single motion may be wrong by less than the limit
    EXPECT_LT(error.rotation, 0.1) << seed;
    EXPECT_LT(error.translation, 0.3) << seed;
    for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(consensus->outlier[i], i == 11) << seed << " " << i;
  }
}

TEST(Consensus, CleanMotionIsNeverLeftOut) {
  for (const testing::Motion motion : {testing::Motion::free, testing::Motion::dominant_axis})
    for (const double noise : {0.0, 0.001, 0.01, 0.1})
      for (std::uint64_t seed = 0; seed < 10; ++seed) {
        Random random(seed);
        std::vector<Statistics> parts;
        for (const MotionPair& pair :
             random_pairs(T_a_b, {.motion = motion, .pairs = 150, .noise = noise}, random))
          parts.push_back(of_one(pair));
        const std::optional<Consensus> consensus = find_consensus(Problem{}, parts);
        ASSERT_TRUE(consensus);
        EXPECT_EQ(std::count(consensus->outlier.begin(), consensus->outlier.end(), true), 0)
            << noise << " " << seed;
      }
}

TEST(Consensus, TooFewPartsOrNoMotionHaveNone) {
  Random random(1);
  std::vector<Statistics> parts;
  for (const MotionPair& pair : random_pairs(T_a_b, {.pairs = 15}, random)) parts.push_back(of_one(pair));
  EXPECT_FALSE(find_consensus(Problem{}, parts));
  EXPECT_FALSE(find_consensus(Problem{}, std::vector<Statistics>(40, of_one({}))));
  EXPECT_FALSE(find_consensus(Problem{}, std::vector<Statistics>(40)));
  // and what holds nothing harms nothing
  parts.clear();
  for (const MotionPair& pair : random_pairs(T_a_b, {.pairs = 40, .noise = 0.05}, random))
    parts.push_back(of_one(pair));
  parts.resize(400);
  const std::optional<Consensus> consensus = find_consensus(Problem{}, parts);
  ASSERT_TRUE(consensus);
  EXPECT_LT(extrinsic_error(T_a_b, consensus->agreement.q).rotation, 0.1);
}

/// A few degrees are within the noise of single motions, not of a run of them.
TEST(Consensus, ARunThatWouldRatherHaveAnotherExtrinsicIsLeftOut) {
  const DualQuaternion little_turned = T_a_b * displacement({0.06, 0, 0}, {0, 0, 0});
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    std::vector<Statistics> parts(32);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool wrong = i == 7 || i == 8 || i == 20;
      for (const MotionPair& pair :
           random_pairs(wrong ? little_turned : T_a_b, {.pairs = 64, .noise = 0.03}, random))
        parts[i].add(pair);
    }
    const std::optional<Consensus> consensus = find_consensus(Problem{}, parts);
    ASSERT_TRUE(consensus);
    for (std::size_t i = 0; i < parts.size(); ++i)
      EXPECT_EQ(consensus->outlier[i], i == 7 || i == 8 || i == 20) << seed << " " << i;
    // overlapping motions are as many as they are independent
    const std::optional<Consensus> overlapping = find_consensus(Problem{}, parts, 8);
    ASSERT_TRUE(overlapping);
    EXPECT_EQ(std::count(overlapping->outlier.begin(), overlapping->outlier.end(), true), 0);
  }
}

/// A long way straight on, then the first turn: it contradicts whatever roll was guessed before, and is
/// right.
TEST(RobustStatistics, TheFirstTurnIsNotAnOutlier) {
  Random random(3);
  RobustStatistics statistics;
  const Problem problem;
  std::uint64_t turns = 0;
  const auto add = [&](const DualQuaternion& b) {
    const DualQuaternion noisy = b * testing::normal_displacement(random, 1e-4, 1e-3);
    statistics.add({T_a_b * b * conjugate(T_a_b), noisy}, problem);
    if (statistics.look_is_due()) statistics.look(problem);
  };
  for (int i = 0; i < 500; ++i) add(displacement({0, 0, 0}, {1, 0, 0}));
  for (int i = 0; i < 20; ++i) {
    add(displacement({0, 0, 0.1}, {1, 0.05, 0}));
    ++turns;
    EXPECT_TRUE(i < 3 || statistics.outlier_pairs() == 0) << "turning step " << i;
  }
  EXPECT_EQ(statistics.inlier_pairs(), 500 + turns);
}

TEST(RobustStatistics, OutliersInARandomOrderCostNothing) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Problem robust, plain, clean;
    RobustStatistics statistics;
    BlockStatistics all, good;
    for (const MotionPair& pair : contradictory(0.2, 0.01, seed, 500)) {
      statistics.add(pair, robust);
      if (statistics.look_is_due()) statistics.look(robust);
      all.add(pair);
    }
    for (const MotionPair& pair : contradictory(0, 0.01, seed, 500)) good.add(pair);
    robust.blocks = statistics.inliers();
    plain.blocks = all.inliers();
    clean.blocks = good.inliers();
    const auto error = [](const Problem& problem) {
      return extrinsic_error(T_a_b, solve(problem, Method::dual).T_a_b);
    };
    EXPECT_LT(error(robust).rotation, 2 * error(clean).rotation + 1e-3) << seed;
    EXPECT_LT(error(robust).translation, 2 * error(clean).translation + 1e-2) << seed;
    EXPECT_GT(error(plain).rotation, 20 * error(robust).rotation) << seed;
    EXPECT_EQ(statistics.inlier_pairs() + statistics.outlier_pairs(), 500u);
  }
}

/// A minority is outvoted, whichever came first: 150 wrong ones, then 400 right ones.
TEST(RobustStatistics, AWrongBeginningIsOutvotedLater) {
  RobustStatistics statistics;
  Problem problem;
  const auto add = [&](const std::vector<MotionPair>& pairs) {
    for (const MotionPair& pair : pairs) {
      statistics.add(pair, problem);
      if (statistics.look_is_due()) statistics.look(problem);
    }
  };
  add(contradictory(1, 0.01, 1, 150));
  problem.blocks = statistics.inliers();
  EXPECT_LT(extrinsic_error(another, solve(problem, Method::dual).T_a_b).rotation, 0.01);
  problem.blocks.clear();
  add(contradictory(0, 0.01, 2, 400));
  statistics.look(problem);
  problem.blocks = statistics.inliers();
  EXPECT_LT(extrinsic_error(T_a_b, solve(problem, Method::dual).T_a_b).rotation, 0.01);
  EXPECT_NEAR(static_cast<double>(statistics.outlier_pairs()), 150, 30);
}

TEST(RobustStatistics, AreBoundedAndContinueFromTheirStateBitForBit) {
  const auto pairs = contradictory(0.3, 0.01, 5, 2000);
  const auto run = [&](std::size_t cut) {
    RobustStatistics statistics;
    const Problem problem;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i == cut) statistics = RobustStatistics(statistics.state());
      statistics.add(pairs[i], problem);
      if (statistics.look_is_due()) statistics.look(problem);
      EXPECT_LE(statistics.state().waiting.size(), RobustOptions{}.most_waiting);
      EXPECT_LE(statistics.state().blocks.state().blocks.size(), BlockStatistics::max_blocks);
    }
    return sum_blocks(statistics.inliers());
  };
  const Statistics expected = run(pairs.size());
  for (const std::size_t cut : {1u, 17u, 100u, 1999u}) EXPECT_EQ(run(cut).dual_rows, expected.dual_rows);
}

}  // namespace
}  // namespace egocal::test_consensus
