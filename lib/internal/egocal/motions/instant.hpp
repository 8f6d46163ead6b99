// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// Poses of both sensors at one time.
struct Instant {
  std::int64_t time_us = 0;  ///< [us], on the clock of a
  DualQuaternion a, b;       ///< unit; each in its own odometry frame
  /// Instants of one chain belong to one odometry frame and one clock each: no motion may join two chains.
  std::uint64_t chain = 0;
  /// How many instants were synchronised up to this one, or up to the one that confirmed it.
  std::uint64_t number = 0;
};

/// Pose of the later frame in the earlier one, with a scalar part >= 0.
inline DualQuaternion motion_between(const DualQuaternion& from, const DualQuaternion& to) {
  return canonical_sign(normalized(conjugate(from) * to));
}

}  // namespace egocal
