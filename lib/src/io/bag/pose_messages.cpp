// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/pose_messages.hpp"

#include "io/bag/message_decoder.hpp"

namespace egocal::detail {

namespace {

/// Reads a std_msgs/Header.
void read_header(MessageDecoder& from, MessagePose& pose) {
  if (from.ros1()) from.u32();  // sequence number
  const std::int64_t seconds = from.ros1() ? static_cast<std::int64_t>(from.u32()) : from.i32();
  pose.time_ns = seconds * 1'000'000'000 + from.u32();
  pose.parent = from.text();
}

/// Reads a geometry_msgs/Pose or geometry_msgs/Transform: x y z, then the quaternion x y z w.
void read_pose(MessageDecoder& from, MessagePose& pose) {
  for (int i = 0; i < 3; ++i) pose.translation[i] = from.f64();
  for (const int i : {1, 2, 3, 0}) pose.wxyz[i] = from.f64();
}

void read_transform_stamped(MessageDecoder& from, MessagePose& pose) {
  read_header(from, pose);
  pose.child = from.text();
  read_pose(from, pose);
}

bool is_twist_type(std::string_view type) {
  return type == "geometry_msgs/TwistStamped" || type == "geometry_msgs/TwistWithCovarianceStamped";
}

}  // namespace

bool is_transforms_type(std::string_view type) {
  return type == transforms_type || type == "tf/tfMessage";
}

bool is_pose_type(std::string_view type) {
  return is_twist_type(type) || type == "nav_msgs/Odometry" || type == "geometry_msgs/PoseStamped" ||
         type == "geometry_msgs/PoseWithCovarianceStamped" || type == "geometry_msgs/TransformStamped" ||
         is_transforms_type(type);
}

bool decode_poses(std::string_view type, std::string_view encoding, ByteSpan data,
                  const std::function<void(const MessagePose&)>& take) {
  MessageDecoder from(encoding, data);
  MessagePose pose;
  if (is_transforms_type(type)) {
    constexpr std::size_t smallest = 64;  // [bytes] of one transform
    const std::uint32_t count = from.u32();
    if (!from.ok() || count > from.left() / smallest) return false;
    for (std::uint32_t i = 0; i < count; ++i) {
      read_transform_stamped(from, pose);
      if (!from.ok()) return false;
      take(pose);
    }
    return true;
  }
  if (!is_pose_type(type)) return false;
  if (is_twist_type(type)) {
    read_header(from, pose);
    pose.velocity = true;
    for (int i = 0; i < 3; ++i) pose.linear[i] = from.f64();
    for (int i = 0; i < 3; ++i) pose.angular[i] = from.f64();
  } else if (type == "geometry_msgs/TransformStamped") {
    read_transform_stamped(from, pose);
  } else {
    read_header(from, pose);
    if (type == "nav_msgs/Odometry") pose.child = from.text();
    read_pose(from, pose);
  }
  if (!from.ok()) return false;
  take(pose);
  return true;
}

}  // namespace egocal::detail
