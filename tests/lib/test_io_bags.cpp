// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bags of every kind: what was written is read, and real ones hold what they are known to hold.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "../support/bag_drives.hpp"
#include "../support/bag_writer.hpp"
#include "../support/paths.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_bags {
namespace {

using testing::all_types;
using testing::BagOptions;
using testing::expect_equal;
using testing::MessageEncoder;
using testing::pose_types;
using testing::some_trajectory;

void expect_all_types(const std::string& file, const Trajectory& trajectory) {
  for (const std::string& type : pose_types) {
    const std::string topic = ":/" + type.substr(type.find('/') + 1);
    const TrajectoryReading reading = read_trajectory_file(file + topic);
    expect_equal(reading.trajectory, trajectory, file + topic);
    EXPECT_FALSE(reading.losses.any()) << file << topic << losses_in_words(reading.losses);
  }
  expect_equal(read_trajectory(file + ":/TFMessage:odom/base/link"), trajectory, "frames with slashes");
  for (const char* frames : {"/odom/base/link", "odom//base/link", "/odom//base/link"})
    expect_equal(read_trajectory(file + ":/TFMessage:" + frames), trajectory, "frames as of tf1");
  expect_equal(read_trajectory(file + ":Odometry"), trajectory, "topic without its slash");
}

TEST(Bags, McapIsReadHoweverItIsPacked) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(120);
  for (const MessageEncoder::Kind kind : {MessageEncoder::Kind::cdr, MessageEncoder::Kind::cdr_big_endian})
    for (const char* compression : {"", "lz4", "zstd"})
      for (const std::size_t chunk : {0u, 50u})
        for (const bool checksums : {false, true})
          expect_all_types(
              folder.file("drive.mcap", testing::mcap_file(all_types(trajectory, kind),
                                                           {compression, chunk, checksums, "cdr"})),
              trajectory);
  BagOptions ros1;
  ros1.message_encoding = "ros1";
  expect_all_types(
      folder.file("ros1.mcap", testing::mcap_file(all_types(trajectory, MessageEncoder::Kind::ros1), ros1)),
      trajectory);
}

TEST(Bags, Rosbag1IsReadHoweverItIsPacked) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(120);
  for (const char* compression : {"none", "bz2", "lz4"})
    expect_all_types(
        folder.file("drive.bag",
                    testing::rosbag1_file(all_types(trajectory, MessageEncoder::Kind::ros1), {compression})),
        trajectory);
}

TEST(Bags, Rosbag2DatabasesAndFoldersOfThemAreRead) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(120);
  const auto messages = all_types(trajectory, MessageEncoder::Kind::cdr);
  testing::write_db3(folder.path("drive?50%.db3"), messages);
  expect_all_types(folder.path("drive?50%.db3"), trajectory);
  // a recording in parts, of which the tenth comes after the second
  const testing::ScratchFolder parts;
  const auto part = [&](int first, int last) {
    return testing::as_messages({trajectory.begin() + first, trajectory.begin() + last}, "/odom",
                                pose_types[0], MessageEncoder::Kind::cdr);
  };
  testing::write_db3(parts.path("drive_2.db3"), part(0, 40));
  testing::write_db3(parts.path("drive_10.db3"), part(40, 120));
  const TrajectoryReading reading = read_trajectory_file(parts.path("") + ":/odom");
  expect_equal(reading.trajectory, trajectory, "folder");
  EXPECT_EQ(reading.out_of_order, 0u);
}

TEST(Bags, PackedFilesAreUnpackedOnTheWay) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(120);
  const auto messages = testing::as_messages(trajectory, "/odom", pose_types[0], MessageEncoder::Kind::cdr);
  const std::string file = testing::mcap_file(messages, {});
  expect_equal(read_trajectory(folder.file("drive.mcap.zstd", testing::packed("zstd", file))), trajectory,
               "zstd");
  write_tum(folder.path("a.tum"), trajectory);
  ASSERT_EQ(std::system(("gzip -k " + folder.path("a.tum")).c_str()), 0);
  expect_equal(read_trajectory(folder.path("a.tum.gz")), trajectory, "gzip");
}

class RealBags : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(bags)) GTEST_SKIP() << "shared/data/bags is not there";
  }
  const std::string bags = paths::data_dir() + "/bags/";
};

TEST_F(RealBags, HoldWhatTheirIndexesSay) {
  EXPECT_EQ(read_trajectory(bags + "ROS_example.bag:groundtruth").size(), 12765u);
  EXPECT_EQ(read_trajectory(bags + "ROS_example.bag:ORB-SLAM").size(), 8362u);
  EXPECT_EQ(read_trajectory(bags + "ROS_example.bag:S-PTAM").size(), 5439u);
  EXPECT_EQ(read_trajectory(bags + "nav2_turtlebot.mcap:/odom").size(), 2639u);
  const Trajectory ros1 = read_trajectory(bags + "tf_example.bag:/tf");
  expect_equal(read_trajectory(bags + "tf_example.db3:/tf"), ros1, "the same recording in two formats");
  EXPECT_EQ(ros1.size(), 517u);
}

/// /odom and /tf of one robot say the same.
TEST_F(RealBags, OdometryAndItsTransformAgree) {
  const Trajectory odometry = read_trajectory(bags + "nav2_turtlebot.mcap:/odom");
  const Trajectory transform = read_trajectory(bags + "nav2_turtlebot.mcap:/tf:odom/base_link");
  expect_equal(transform, odometry, "odom");
}

}  // namespace
}  // namespace egocal::test_io_bags
