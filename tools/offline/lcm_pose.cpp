// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/lcm_pose.hpp"

#include "egocal/limits.hpp"
#include "offline/lcm_ros_types.hpp"

namespace egocal::tools {

LcmPose decode_lcm_pose(bus::Bytes bytes) {
  odometry_t odometry{};
  if (bus::decode(bytes, odometry))
    return {bus::to_stamped_pose(odometry), odometry.seq, "egocal.odometry_t"};
  bot_core::pose_t pose{};
  if (bus::decode(bytes, pose)) return {bus::to_stamped_pose(pose), -1, "bot_core.pose_t"};
  if (const auto ros = decode_lcm_ros_pose(bytes)) {
    if (!plausible_time(ros->time_us)) return {{std::nullopt, "implausible time"}, -1, ros->type};
    if (ros->velocity) {
      const double* v = ros->twist;
      LcmPose message{{std::nullopt, "holds velocities only"}, -1, ros->type};
      message.twist = Twist{ros->time_us, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
      return message;
    }
    const bus::Checked<DualQuaternion> checked = bus::to_dual_quaternion(ros->position, ros->quaternion);
    if (!checked) return {{std::nullopt, checked.reason}, -1, ros->type};
    return {{StampedPose{ros->time_us, *checked.value}, ""}, -1, ros->type};
  }
  return {{std::nullopt, "not a pose message"}, -1, ""};
}

LcmPose with_integrated_pose(LcmPose message, TwistIntegrator& stream) {
  if (!message.twist) return message;
  if (const std::optional<DualQuaternion> pose = stream.add(*message.twist))
    message.pose = {StampedPose{message.twist->time_us, *pose}, ""};
  else
    message.pose.reason = "a velocity that is not finite, or not later than the one before";
  return message;
}

}  // namespace egocal::tools
