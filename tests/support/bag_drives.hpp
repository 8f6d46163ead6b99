// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives as messages of every kind that holds poses.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bag_writer.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

inline const std::string pose_types[] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                                         "geometry_msgs/PoseWithCovarianceStamped",
                                         "geometry_msgs/TransformStamped", "tf2_msgs/TFMessage"};

inline Trajectory some_trajectory(int poses, std::uint64_t seed = 1) {
  Random random(seed);
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i)
    trajectory.push_back({1'700'000'000'123'456 + 50'001 * i, random_extrinsic(random)});
  return trajectory;
}

inline void expect_equal(const Trajectory& read, const Trajectory& written, const std::string& what) {
  ASSERT_EQ(read.size(), written.size()) << what;
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].time_us, written[i].time_us) << what << " pose " << i;
    ASSERT_LT((read[i].pose.vec() - written[i].pose.vec()).norm(), 1e-12) << what << " pose " << i;
  }
}

inline std::vector<WrittenMessage> all_types(const Trajectory& trajectory, MessageEncoder::Kind kind) {
  std::vector<WrittenMessage> messages;
  for (const std::string& type : pose_types)
    for (WrittenMessage& message : as_messages(trajectory, "/" + type.substr(type.find('/') + 1), type, kind))
      messages.push_back(std::move(message));
  messages.push_back({"/image", "sensor_msgs/Image", 1, std::string(5000, 'x')});
  return messages;
}

inline std::string refusal_of(const std::string& name) {
  try {
    read_trajectory(name);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << name << " was read";
  return "";
}

}  // namespace egocal::testing
