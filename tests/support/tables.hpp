// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Text files of poses, as people have them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "scratch_folder.hpp"

namespace egocal::testing {

class Tables : public ::testing::Test {
 protected:
  TrajectoryReading read(const std::string& content, const ReadOptions& options = {}) const {
    return read_trajectory_file(folder_.file("table", content), options);
  }
  /// Two poses: at 1e9 s and 0.1 s later, x y z = 1 2 3 and 4 5 6, turned by 90 degrees about z.
  void expect_two_poses(const std::string& content, const ReadOptions& options = {}) const {
    const TrajectoryReading reading = read(content, options);
    ASSERT_EQ(reading.trajectory.size(), 2u) << content;
    EXPECT_EQ(reading.trajectory[0].time_us, 1'000'000'000'000'000) << content;
    EXPECT_EQ(reading.trajectory[1].time_us, 1'000'000'000'100'000) << content;
    const Pose first = to_pose(reading.trajectory[0].pose), second = to_pose(reading.trajectory[1].pose);
    EXPECT_LT((first.translation - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9) << content;
    EXPECT_LT((second.translation - Eigen::Vector3d(4, 5, 6)).norm(), 1e-9) << content;
    EXPECT_LT((rotation_log(first.rotation) - Eigen::Vector3d(0, 0, std::numbers::pi / 2)).norm(), 1e-5)
        << content;
  }
  void expect_error(const std::string& content, const std::string& part,
                    const ReadOptions& options = {}) const {
    try {
      read(content, options);
      ADD_FAILURE() << "accepted: " << content;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(part)) << content;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  testing::ScratchFolder folder_;
};

}  // namespace egocal::testing
