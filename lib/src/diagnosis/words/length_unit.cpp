// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "egocal/diagnosis/options.hpp"

namespace egocal {

LengthUnit unit_of_scaled(LengthUnit unit, double scale) {
  // two sensors that both mean metres do not differ by more
  constexpr double near_one = 1.1;
  if (unit != LengthUnit::metres_where_alike) return unit;
  return std::abs(std::log(scale)) < std::log(near_one) ? LengthUnit::metres : LengthUnit::unknown;
}

}  // namespace egocal
