// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/statistics/median.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../support/random_motion.hpp"

namespace egocal::test_median {
namespace {

using detail::median;
using detail::order_statistic_in_place;

TEST(Median, IsTheLargerOfTheTwoInTheMiddleOfAnEvenNumber) {
  EXPECT_EQ(median(std::vector<double>{3}), 3);
  EXPECT_EQ(median(std::vector<double>{3, 1}), 3);
  EXPECT_EQ(median(std::vector<double>{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<std::int64_t>{7, 2, 2, 9}), 7);
  EXPECT_EQ(median(std::vector<float>{0.1F, 0.3F, 0.2F}), 0.2F);
}

TEST(Median, IsZeroWhereThereAreNone) {
  EXPECT_EQ(median(std::vector<double>{}), 0);
  EXPECT_EQ(median(std::vector<std::int64_t>{}), 0);
}

TEST(Median, LeavesTheValuesOfItsCallerUnlikeOneInPlace) {
  std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(median(values), 3);
  EXPECT_EQ(values, (std::vector<double>{5, 1, 4, 2, 3}));
  EXPECT_EQ(order_statistic_in_place(values, 0), 1);
  EXPECT_THAT(values, ::testing::UnorderedElementsAre(1, 2, 3, 4, 5));
}

TEST(OrderStatisticInPlace, IsWhatSortingFinds) {
  testing::Random random(1);
  for (std::size_t size = 1; size < 80; ++size) {
    std::vector<double> values;
    // some of them are equal
    for (std::size_t i = 0; i < size; ++i) values.push_back(static_cast<double>(random.below(50)));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(values), sorted[size / 2]) << size;
    for (const std::size_t place : {std::size_t{0}, size / 5, (size - 1) / 2, size - 1}) {
      std::vector<double> given = values;
      EXPECT_EQ(order_statistic_in_place(given, place), sorted[place]) << size;
    }
  }
}

}  // namespace
}  // namespace egocal::test_median
