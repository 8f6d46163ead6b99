// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The third stage of the pairing: motions of every stride, and when their settings are chosen.
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/pairing_stages.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_accumulator {
namespace {

using testing::instants_of;
using testing::period_us;
using testing::simulated;
using testing::Streams;

TEST(Accumulator, NoMotionJoinsTwoChains) {
  const Streams data = simulated(300);
  PairingOptions options{.stride = 4, .balance = Balance{}};
  Accumulator accumulator(options);
  accumulator.begin(period_us);
  std::size_t pairs = 0;
  for (Instant instant : instants_of(data)) {
    instant.chain = instant.number > 150 ? 1 : 0;
    for (const MotionPair& pair : accumulator.add(instant)) {
      ++pairs;
      EXPECT_FALSE(pair.begin_us < data.a[150].time_us && pair.end_us >= data.a[150].time_us);
    }
  }
  EXPECT_EQ(pairs, 300u - 2 * 4);
  EXPECT_EQ(accumulator.inlier_pairs() + accumulator.outlier_pairs(), pairs);
}

TEST(Accumulator, ContinuesFromItsStateBitForBit) {
  const std::vector<Instant> instants = instants_of(simulated(300));
  PairingOptions options;
  Accumulator whole(options), parts(options);
  whole.begin(period_us);
  parts.begin(period_us);
  for (const Instant& instant : instants) {
    whole.add(instant);
    if (instant.number % 37 == 0) parts = Accumulator(options, parts.state());
    parts.add(instant);
  }
  EXPECT_EQ(cost_matrix(whole.problem()), cost_matrix(parts.problem()));
  EXPECT_EQ(whole.choice().stride, parts.choice().stride);
}

TEST(Accumulator, SpreadsLooksForOutliersAndChoicesOverPoses) {
  Accumulator accumulator{PairingOptions{}};
  accumulator.begin(period_us);
  AccumulatorState before = accumulator.state();
  std::size_t looks = 0, choices = 0, waited = 0;
  std::uint64_t due = before.sums->next_choice;
  for (const Instant& instant : instants_of(simulated(700))) {
    accumulator.add(instant);
    const AccumulatorState now = accumulator.state();
    std::size_t here = 0;
    for (std::size_t i = 0; i < now.strides.size(); ++i)
      if (now.strides[i].statistics.state().next_look != before.strides[i].statistics.state().next_look)
        ++here;
    EXPECT_LE(here, 2u) << "pose " << instant.number;  // the stride in force looks more often
    looks += here;
    const bool chose = now.next_choice != before.next_choice;
    ASSERT_TRUE(now.sums);
    const bool chose_sums = now.sums->next_choice != before.sums->next_choice;
    // a drive may end here: weights of an older choice would be worse (docs/benchmarks.md); but two choices
    // in one step take too long
    EXPECT_FALSE(chose && chose_sums) << "pose " << instant.number;
    const bool waits = now.sums->next_index >= now.sums->next_choice;
    EXPECT_FALSE(waits && !chose) << "pose " << instant.number;
    waited += waits ? 1 : 0;
    // the wait does not move the choices that follow
    if (chose_sums) {
      EXPECT_LE(now.sums->next_choice, due + std::max<std::uint64_t>(1, due / 4));
    }
    due = now.sums->next_choice;
    choices += (chose ? 1 : 0) + (chose_sums ? 1 : 0);
    before = now;
  }
  EXPECT_GT(looks, 40u);
  EXPECT_GT(choices, 15u);
  EXPECT_GE(waited, 1u);
  EXPECT_LE(waited, 3u);
}

TEST(Accumulator, PairsOfOneRigChooseAtDifferentTimes) {
  constexpr std::size_t pairs = 8;
  const std::vector<Instant> instants = instants_of(simulated(1000));
  const auto choices_at_once = [&instants](bool staggered) {
    std::vector<Accumulator> all;
    for (std::size_t k = 0; k < pairs; ++k) {
      PairingOptions options;
      if (staggered) options.accumulator.choice_phase = static_cast<double>(k) / pairs;
      all.emplace_back(options).begin(period_us);
    }
    std::vector<std::uint64_t> next(pairs);
    std::size_t most = 0, sum = 0;
    for (const Instant& instant : instants) {
      std::size_t here = 0;
      for (std::size_t k = 0; k < pairs; ++k) {
        all[k].add(instant);
        const std::uint64_t now = all[k].state().sums->next_choice;
        here += now != next[k] ? 1 : 0;
        next[k] = now;
      }
      // the first choices are made within eight poses
      if (instant.number > 200) most = std::max(most, here);
      sum += here;
    }
    return std::pair{most, sum};
  };
  const auto [at_once, count] = choices_at_once(false);
  const auto [staggered, count_staggered] = choices_at_once(true);
  EXPECT_EQ(at_once, pairs);
  EXPECT_LE(staggered, 2u);
  EXPECT_NEAR(static_cast<double>(count_staggered), static_cast<double>(count),
              0.1 * static_cast<double>(count));
}

}  // namespace
}  // namespace egocal::test_accumulator
