// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Chances, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "statistics/distributions.hpp"

namespace egocal::test_distributions {
namespace {

TEST(Distributions, TailsOfFAreRight) {
  for (const double f : {0.1, 1.0, 4.0, 50.0}) {
    EXPECT_NEAR(detail::f_exceeded(f, 1, 1), 1 - 2 / std::numbers::pi * std::atan(std::sqrt(f)), 1e-11) << f;
    // P(F(d, 2) > f) = 1 - (d f / (2 + d f))^(d / 2)
    EXPECT_NEAR(detail::f_exceeded(f, 6, 2), 1 - std::pow(6 * f / (2 + 6 * f), 3), 1e-11) << f;
  }
  EXPECT_EQ(detail::f_exceeded(-1, 6, 40), 1);
  EXPECT_EQ(detail::f_exceeded(1, 6, 0), 1);
  // P(F(2, d) > f) = (1 + 2 f / d)^(-d / 2)
  for (const double f : {0.1, 1.0, 5.0, 20.0})
    EXPECT_NEAR(detail::f_exceeded(f, 2, 30) / std::pow(1 + 2 * f / 30, -15), 1, 1e-10) << f;
}

}  // namespace
}  // namespace egocal::test_distributions
