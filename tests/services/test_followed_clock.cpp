// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses of a clock that drifts, as pairing took them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "diagnosis/followed_clock.hpp"
#include "egocal/error.hpp"

namespace egocal::services::test_followed_clock {
namespace {

constexpr std::int64_t second = 1'000'000, start_us = 1'600'000'000 * second;

TEST(FollowedClock, GivesPosesTheStampsOfAClockThatDoesNotDrift) {
  FollowedClock clock;
  Trajectory b;
  // b is slow by 1e-3: its offset grows by 1 ms each second
  for (std::int64_t i = 0; i <= 1000; ++i) {
    b.push_back({start_us + i * second - 1000 * i, {}});
    if (i >= 10) clock.add(start_us + i * second, 1000 * i);
  }
  const Trajectory corrected = clock.at_newest_offset(b);
  ASSERT_EQ(corrected.size(), b.size());
  for (std::int64_t i = 20; i <= 1000; ++i)
    ASSERT_NEAR(static_cast<double>(corrected[static_cast<std::size_t>(i)].time_us + 1'000'000 - start_us),
                static_cast<double>(i * second), 5.0)
        << i;
  EXPECT_LE(clock.offsets().size(), FollowedClockOptions().most);
}

TEST(FollowedClock, OfOneOffsetChangesNothing) {
  FollowedClock clock;
  Trajectory b;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    b.push_back({start_us + i * second, {}});
    clock.add(start_us + i * second, 350'000 + i % 7);
  }
  EXPECT_LE(clock.offsets().size(), 2u);
  const Trajectory corrected = clock.at_newest_offset(b);
  ASSERT_EQ(corrected.size(), b.size());
  for (std::size_t i = 0; i < b.size(); ++i) ASSERT_LE(std::abs(corrected[i].time_us - b[i].time_us), 10);
}

// An offset that held for long before it changed is not interpolated over all of that time.
TEST(FollowedClock, AChangeOfTheOffsetIsWhereItWas) {
  FollowedClock clock;
  for (std::int64_t i = 0; i < 100; ++i) clock.add(start_us + i * second, i < 80 ? 0 : 5000);
  const Trajectory corrected =
      clock.at_newest_offset({{start_us + 40 * second, {}}, {start_us + 90 * second, {}}});
  EXPECT_EQ(corrected[0].time_us, start_us + 40 * second - 5000);
  EXPECT_EQ(corrected[1].time_us, start_us + 90 * second);
}

// Set by 0.5 s after a minute, which pairing knew of after 92 s: of a step at each of the two times something
// in between was reported.
TEST(FollowedClock, WhatAClockWasSetByIsLeftWhereItWas) {
  FollowedClock clock;
  for (std::int64_t i = 0; i < 1200; ++i)
    clock.add(start_us + i * second / 10, i < 920 ? 10 * i : 10 * i - 500'000);
  const std::int64_t newest = 10 * 1199 - 500'000;
  Trajectory b;
  for (std::int64_t i = 0; i < 1200; ++i)
    b.push_back({start_us + i * second / 10 - 10 * i + (i < 600 ? 0 : 500'000), {}});
  const Trajectory corrected = clock.at_newest_offset(b);
  ASSERT_EQ(corrected.size(), b.size());
  for (std::int64_t i = 0; i < 1200; ++i)
    EXPECT_NEAR(static_cast<double>(corrected[static_cast<std::size_t>(i)].time_us + newest - start_us),
                static_cast<double>(i * second / 10 - (i < 600 ? 500'000 : 0)), 60)
        << "the drift is taken off, " << i;
}

// Of a pair whose scale is found, a problem may come again with a newer offset.
TEST(FollowedClock, TheLastOffsetOfOneTimeCounts) {
  FollowedClock clock;
  clock.add(start_us, 1000);
  clock.add(start_us, 3000);
  clock.add(start_us - 1, 9000);
  ASSERT_EQ(clock.offsets().size(), 1u);
  EXPECT_EQ(clock.offsets().front().offset_us, 3000);
}

TEST(FollowedClock, PosesNeverRunBackwards) {
  FollowedClock clock;
  for (std::int64_t i = 0; i < 20; ++i) clock.add(start_us + i * second / 10, i < 10 ? 2 * second : 0);
  Trajectory b;
  for (std::int64_t i = 0; i < 60; ++i) b.push_back({start_us + (i - 30) * second / 10, {}});
  const Trajectory corrected = clock.at_newest_offset(b);
  EXPECT_GT(corrected.size(), 20u);
  EXPECT_TRUE(std::is_sorted(corrected.begin(), corrected.end(),
                             [](const auto& x, const auto& y) { return x.time_us < y.time_us; }));
}

TEST(FollowedClock, ADamagedStateIsRefused) {
  FollowedClock clock;
  clock.restore({{start_us, 5}, {start_us + 1, 6}});
  EXPECT_EQ(clock.offsets().size(), 2u);
  EXPECT_THROW(clock.restore({{start_us, 5}, {start_us, 6}}), Error);
  EXPECT_THROW(clock.restore({{INT64_MAX, 5}}), Error);
  EXPECT_THROW(clock.restore(std::vector<OffsetSince>(2000)), Error);
  EXPECT_EQ(clock.offsets().size(), 2u);
}

}  // namespace
}  // namespace egocal::services::test_followed_clock
