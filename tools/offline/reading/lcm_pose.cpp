// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/lcm_pose.hpp"

#include "egocal/limits.hpp"
#include "offline/reading/lcm_ros_types.hpp"

namespace egocal::tools {

namespace {

LcmPose decode_with(bus::Bytes bytes, std::int64_t recorded_us, bool& unstamped) {
  const auto fill_in = [&](std::int64_t& time_us) {
    unstamped = time_us == 0 && recorded_us != 0;
    if (unstamped) time_us = recorded_us;
  };
  odometry_t odometry{};
  if (bus::decode(bytes, odometry)) {
    fill_in(odometry.utime);
    return {bus::to_stamped_pose(odometry), odometry.seq, "egocal.odometry_t"};
  }
  bot_core::pose_t pose{};
  if (bus::decode(bytes, pose)) {
    fill_in(pose.utime);
    return {bus::to_stamped_pose(pose), -1, "bot_core.pose_t"};
  }
  if (auto ros = decode_lcm_ros_pose(bytes)) {
    fill_in(ros->time_us);
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

}  // namespace

LcmPose decode_lcm_pose(bus::Bytes bytes, std::int64_t recorded_us) {
  bool unstamped = false;
  LcmPose message = decode_with(bytes, recorded_us, unstamped);
  message.unstamped = unstamped;
  return message;
}

LcmPose ChannelTimes::checked(LcmPose message) {
  if (message.type.empty()) return message;
  if (!message.unstamped) {
    ++stamped_;
  } else if (stamped_ == 0) {
    ++unstamped_;
  } else {
    message.twist.reset();
    message.pose = {std::nullopt, "no time stamp, others of the channel have one"};
  }
  return message;
}

std::string ChannelTimes::note() const {
  if (unstamped_ == 0) return {};
  return std::to_string(unstamped_) + (unstamped_ == 1 ? " message has" : " messages have") +
         " no time stamp: the time of recording was taken";
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
