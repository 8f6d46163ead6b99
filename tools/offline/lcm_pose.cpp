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
    const bus::Checked<DualQuaternion> checked = bus::to_dual_quaternion(ros->position, ros->quaternion);
    if (!checked) return {{std::nullopt, checked.reason}, -1, ros->type};
    return {{StampedPose{ros->time_us, *checked.value}, ""}, -1, ros->type};
  }
  return {{std::nullopt, "not a pose message"}, -1, ""};
}

}  // namespace egocal::tools
