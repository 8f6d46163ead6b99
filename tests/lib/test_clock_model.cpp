// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "diagnosis/motions/motions.hpp"

namespace egocal::detail::test_clock_model {
namespace {

TEST(ClockModel, AddsOffsetAndDrift) {
  const ClockModel clock{0.25, 1e-3, 100};
  EXPECT_DOUBLE_EQ(clock.on_clock_of_a(100), 100.25);
  EXPECT_DOUBLE_EQ(clock.on_clock_of_a(300), 300.45);
  EXPECT_DOUBLE_EQ(ClockModel{}.on_clock_of_a(7), 7);
}

TEST(ClockModel, GivesTheTimesOfAStream) {
  const Trajectory poses{{5'000'000, {}}, {7'000'000, {}}};
  const ClockModel clock{-0.5, 0.01, 1};
  const Times times(poses, 4'000'000, clock);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0], clock.on_clock_of_a(1));
  EXPECT_EQ(times[1], clock.on_clock_of_a(3));
}

}  // namespace
}  // namespace egocal::detail::test_clock_model
