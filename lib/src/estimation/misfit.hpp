// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "egocal/problem/cost.hpp"

namespace egocal::detail {

/// Logarithm of the product of the mean squared residuals of rotations and of translations at q (planar mode:
/// T_p). Smaller is more likely: it is the likelihood of Gaussian noise of unknown sizes. rounding_rotation,
/// rounding_translation: smaller residuals count as these [rad, m]. Zero without motions.
inline double misfit(const Statistics& motions, const DualQuaternion& q, double rounding_rotation,
                     double rounding_translation) {
  if (!(motions.weight > 0)) return 0;
  const auto log_of = [&](double squares, double rounding) {
    return std::log(std::max(squares / motions.weight, rounding * rounding));
  };
  const Vector8d v = q.vec();
  return log_of(q.real.dot(motions.dual_rows.bottomRightCorner<4, 4>() * q.real), rounding_rotation) +
         log_of(v.dot(motions.dual_rows * v), rounding_translation);
}

}  // namespace egocal::detail
