// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "wire_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace egocal::bus {

bool not_negative(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value >= 0; });
}

bool finite_not_negative(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value) && value >= 0; });
}

bool directions_contradict(const std::int8_t (&observable)[6], const double (&stddev)[6]) {
  for (std::size_t i = 0; i < 6; ++i)
    if (observable[i] == 0 && !std::isinf(stddev[i])) return true;
  return false;
}

bool bounded_by_diagonal(const Matrix8d& matrix, double slack) {
  const Vector8d root = matrix.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column <= row; ++column)
      if (std::abs(matrix(row, column)) > (1 + 1e-9) * root(row) * root(column) + slack) return false;
  return true;
}

}  // namespace egocal::bus
