// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "statistics/order_statistic.hpp"

namespace egocal::detail {

/// The (finite) value that this part of the others is below: the one at part * size of the sorted ones, the
/// last one at most. 0 where there are none.
inline double quantile(std::span<const double> values, double part) {
  if (values.empty()) return 0;
  const auto place = static_cast<std::size_t>(part * static_cast<double>(values.size()));
  return order_statistic(values, std::min(values.size() - 1, place));
}

}  // namespace egocal::detail
