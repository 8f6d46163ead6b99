// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace egocal::detail {

/// The value that would be at `place` if the (finite) numbers were sorted. Changes their order instead of
/// copying them; for numbers that keep their order there is order_statistic (statistics/order_statistic.hpp).
/// place < values.size().
template <typename Number>
Number order_statistic_in_place(std::vector<Number>& values, std::size_t place) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The one at size / 2 of the sorted (finite) numbers: of an even number the larger of the two in the middle,
/// so that it is always one of them. 0 where there are none. Numbers that are not needed afterwards are
/// better moved into it than copied.
template <typename Number>
Number median(std::vector<Number> values) {
  return values.empty() ? Number{} : order_statistic_in_place(values, values.size() / 2);
}

/// Median distance of the (finite) numbers from their median, as a part of the median; of numbers near zero
/// as a part of 1e-12.
inline double relative_deviation(std::vector<double> values) {
  const double typical = median(values);
  for (double& value : values) value = std::abs(value - typical);
  return median(std::move(values)) / std::max(typical, 1e-12);
}

}  // namespace egocal::detail
