// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/congruence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../support/random_motion.hpp"

namespace egocal {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

const DualQuaternion T_a_b = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});

/// Small motions, of which a part is spoilt by up to tens of times their size.
TEST(Congruence, PairsInAnyOrderAreJudgedByTheirLike) {
  for (const std::uint64_t count : {100u, 1500u, 2500u})
    for (const double part : {0.0, 0.05, 0.2, 0.3})
      for (const double size : {0.5, 2.0}) {
        Random random(count);
        auto pairs = random_pairs(
            T_a_b, {.pairs = count, .rotation = 0.05, .translation = 0.3, .noise = 0.01}, random);
        std::vector<bool> spoilt;
        for (MotionPair& pair : pairs) {
          spoilt.push_back(random.uniform() < part);
          if (spoilt.back())
            pair.b = canonical_sign(normalized(pair.b * normal_displacement(random, size, size)));
        }
        const std::vector<bool> found = incongruent(pairs);
        ASSERT_EQ(found.size(), count);
        int missed = 0, wronged = 0;
        for (std::size_t i = 0; i < count; ++i) {
          missed += spoilt[i] && !found[i];
          wronged += !spoilt[i] && found[i];
        }
        EXPECT_LE(missed, 0.05 * part * static_cast<double>(count)) << count << " " << part << " " << size;
        EXPECT_EQ(wronged, 0) << count << " " << part << " " << size;
      }
}

TEST(Congruence, TooFewToTellAreNotJudged) {
  Random random(1);
  auto pairs = random_pairs(T_a_b, {.pairs = 10, .noise = 0.01}, random);
  pairs[3].b = displacement({1, 1, 1}, {3, 0, 0});
  const std::vector<bool> found = incongruent(pairs);
  EXPECT_EQ(std::count(found.begin(), found.end(), true), 0);
  EXPECT_TRUE(incongruent({}).empty());
}

}  // namespace
}  // namespace egocal
