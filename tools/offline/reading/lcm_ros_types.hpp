// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "egocal/bus/decode.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// A pose in one of the ROS-shaped types of the LCM world, as it was sent, not yet checked.
struct LcmRosPose {
  std::string type;           ///< "nav_msgs.Odometry"
  std::int64_t time_us = 0;   ///< stamp of the header [us]
  double position[3] = {};    ///< [m]
  double quaternion[4] = {};  ///< w x y z
  bool velocity = false;      ///< of a TwistStamped: the twist is known instead of the pose
  double twist[6] = {};       ///< vx vy vz [m/s], wx wy wz [rad/s]
};

/// nav_msgs.Odometry, geometry_msgs.TwistStamped, TwistWithCovarianceStamped, PoseStamped,
/// PoseWithCovarianceStamped, TransformStamped (with std_msgs.Header as in ROS 1 and ROS 2) and
/// dairlib.lcmt_ros_odometry, recognised by their fingerprints. Empty for any other type, or where the bytes
/// are not exactly one message.
std::optional<LcmRosPose> decode_lcm_ros_pose(bus::Bytes bytes);

}  // namespace egocal::tools
