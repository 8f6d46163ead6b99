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

/// Which column of a file holds the scalar of the quaternion.
enum class QuaternionOrder {
  as_read,  ///< the one that the file format says
  wxyz,     ///< the first one, in a file that was read as x y z w
  xyzw,     ///< the last one, in a file that was read as w x y z
};

/// How the poses of a stream are to be understood where the file does not mean what its format says. Applied
/// in the order of the members.
struct Reading {
  QuaternionOrder quaternion_order = QuaternionOrder::as_read;
  bool invert = false;  ///< the poses are world-to-sensor: take the inverse of each
  double scale = 1;     ///< factor of all lengths, > 0
};

/// The trajectory as understood by `reading`; times are kept. Poses stay unit dual quaternions. Throws Error
/// where the scale is not finite and above zero.
Trajectory reread(const Trajectory& trajectory, const Reading& reading);

}  // namespace egocal
