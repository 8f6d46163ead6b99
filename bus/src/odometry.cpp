// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/odometry.hpp"

#include "egocal/limits.hpp"

namespace egocal::bus {

namespace {

/// Multiplies the position, and refuses a result that no sensor can have.
void apply_scale(double scale, Checked<StampedPose>& received) {
  if (scale == 1 || !received) return;
  Pose pose = to_pose(received.value->pose);
  pose.translation *= scale;
  if (plausible_distance(pose.translation.x()) && plausible_distance(pose.translation.y()) &&
      plausible_distance(pose.translation.z()))
    received.value->pose = to_dual_quaternion(pose);
  else
    received = {{}, "position out of range"};
}

}  // namespace

std::int64_t utime_in(Bytes message) {
  return message.size() < 16 ? 0 : static_cast<std::int64_t>(big_endian<std::uint64_t>(message, 8));
}

ReceivedOdometry decode_odometry(const Sensor& sensor, Bytes bytes) {
  ReceivedOdometry result;
  if (sensor.type == OdometryType::pose) {
    bot_core::pose_t message{};
    result.decoded = decode(bytes, message);
    if (result.decoded) result.pose = to_stamped_pose(message);
  } else {
    odometry_t message{};
    result.decoded = decode(bytes, message);
    if (result.decoded) result.pose = to_stamped_pose(message);
    result.seq = message.seq;
  }
  apply_scale(sensor.scale, result.pose);
  return result;
}

}  // namespace egocal::bus
