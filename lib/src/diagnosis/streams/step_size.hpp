// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether a pose is repeated.
#pragma once

#include <algorithm>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

/// Largest part of a motion: half-angles and half-lengths as they come.
inline double step_size(const DualQuaternion& motion) {
  return std::max(motion.real.tail<3>().norm(), motion.dual.norm());
}

/// What computing with a pose adds to a motion from it. rounding: of the length and of 1.
inline double rounding_of(const DualQuaternion& pose, double rounding) {
  return rounding * (1 + pose.dual.norm());
}

}  // namespace egocal::detail
