// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/decimals.hpp"

#include <cmath>

namespace egocal::tools {

Eigen::Vector3d without_negative_zeros(Eigen::Vector3d values, int decimals) {
  const double least = 0.5 * std::pow(10.0, -decimals);
  for (double& value : values)
    if (std::abs(value) < least) value = 0;
  return values;
}

}  // namespace egocal::tools
