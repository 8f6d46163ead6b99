// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "egocal/geometry/pose.hpp"
#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// One pose or velocity of a ROS message as it was sent, not yet checked.
struct MessagePose {
  std::int64_t time_ns = 0;         ///< stamp of the header [ns]; 0: the sender did not fill it in
  std::string_view parent, child;   ///< frames; child is empty where the type has none
  Eigen::Vector3d translation;      ///< [m]
  Eigen::Vector4d wxyz;             ///< quaternion as sent, of any length
  bool velocity = false;            ///< of a TwistStamped: only the two below are known
  Eigen::Vector3d linear, angular;  ///< in the frame of the header [m/s, rad/s]
};

/// Whether poses can be taken, or integrated, from messages of this type ("nav_msgs/Odometry", ROS 1 style).
bool is_pose_type(std::string_view type);
inline constexpr std::string_view transforms_type = "tf2_msgs/TFMessage";
/// Whether this is tf2_msgs/TFMessage, or its name before 2013.
bool is_transforms_type(std::string_view type);

/// Hands every pose of the message to `take`: one, or as many as a TFMessage holds. False where the bytes
/// are no message of that type in that encoding ("ros1", "cdr").
bool decode_poses(std::string_view type, std::string_view encoding, ByteSpan data,
                  const std::function<void(const MessagePose&)>& take);

}  // namespace egocal::detail
