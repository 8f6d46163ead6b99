// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/log_trajectory.hpp"

#include <fmt/format.h>

#include <set>

#include "egocal/bus/glue.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

/// Either type of pose message; a message of another type, or with values that are no pose, is refused.
bus::Checked<StampedPose> pose_of(const bus::LogEvent& event) {
  odometry_t odometry{};
  if (bus::decode(event.data, odometry)) return bus::to_stamped_pose(odometry);
  bot_core::pose_t pose{};
  if (bus::decode(event.data, pose)) return bus::to_stamped_pose(pose);
  return {std::nullopt, "not a pose message"};
}

}  // namespace

Trajectory read_log_trajectory(const std::string& file, const std::string& channel) {
  bus::LogReader log(file);
  Trajectory trajectory;
  std::set<std::string> channels;
  std::string refused;
  while (const std::optional<bus::LogEvent> event = log.next()) {
    if (event->channel != channel) {
      channels.insert(event->channel);
      continue;
    }
    const bus::Checked<StampedPose> pose = pose_of(*event);
    if (!pose) {
      refused = pose.reason;
      continue;
    }
    if (!trajectory.empty() && pose.value->time_us <= trajectory.back().time_us) {
      // repeated and late messages are not taken; a jump back begins another session
      constexpr std::int64_t session_jump_us = 10'000'000;
      if (pose.value->time_us < trajectory.back().time_us - session_jump_us) break;
      continue;
    }
    trajectory.push_back(*pose.value);
  }
  if (trajectory.empty()) {
    if (!refused.empty()) throw error_at(file, 0, channel, "no pose in this channel: " + refused);
    std::string known;
    for (const std::string& name : channels) known += (known.empty() ? "" : ", ") + name;
    throw error_at(file, 0, channel,
                   "no such channel in the log; there are: " + (known.empty() ? "none" : known));
  }
  return trajectory;
}

}  // namespace egocal::tools
