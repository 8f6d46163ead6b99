// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace egocal::detail {

/// Where a value is expected: where it is, it is found at a third of the cost; elsewhere only
/// time is lost.
struct Expected {
  double low = 0, high = 0;
};

/// How far from the value before one is expected. Changes the time alone: what lies outside is found among
/// all values. Half of the factor of two that the noise of a drive changes by from one look to the next.
struct ExpectedOptions {
  double lower = 0.7, upper = 1.4;  ///< times the value before
};

/// The value that would be at `place` if the (finite) values were sorted: what std::nth_element finds.
/// place < values.size().
double order_statistic(std::span<const double> values, std::size_t place, const Expected& expected);
/// The same, where nothing is expected: a few of the values say where to look.
double order_statistic(std::span<const double> values, std::size_t place);

}  // namespace egocal::detail
