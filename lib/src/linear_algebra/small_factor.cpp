// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra/small_factor.hpp"

namespace egocal::detail {

SmallFactor::SmallFactor(const SquareUpToSix& matrix) : factor_(matrix) {}

bool SmallFactor::positive() const {
  return factor_.info() == Eigen::Success && factor_.isPositive();
}

UpToSix SmallFactor::solve(const UpToSix& right) const {
  return factor_.solve(right);
}

SquareUpToSix SmallFactor::solve(const SquareUpToSix& right) const {
  return factor_.solve(right);
}

}  // namespace egocal::detail
