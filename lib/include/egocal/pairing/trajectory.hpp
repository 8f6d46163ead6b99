// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// Pose of a sensor in its own odometry (start) frame at a time.
struct StampedPose {
  std::int64_t time_us = 0;  ///< [us]
  DualQuaternion pose;       ///< unit; p_odometry = pose p_sensor
};
EGOCAL_SAME_LAYOUT(StampedPose)

/// Poses with strictly increasing times.
using Trajectory = std::vector<StampedPose>;

enum class Side { a, b };

}  // namespace egocal
