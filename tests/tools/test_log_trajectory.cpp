// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Reading poses from logs: what damage costs, and what is reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "offline/reading/log_trajectory.hpp"
#include "support/damaged_log.hpp"

namespace egocal::tools::test_log_trajectory {
namespace {

using ::testing::HasSubstr;

class LogTrajectoryTest : public ::testing::Test {
 protected:
  LogTrajectoryTest()
      : folder(std::filesystem::temp_directory_path() / ("egocal_trajectory_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder);
  }
  ~LogTrajectoryTest() override { std::filesystem::remove_all(folder); }
  std::string path(const std::string& name) const { return folder / name; }

  std::filesystem::path folder;
};

std::size_t pairs_of(const Trajectory& a, const Trajectory& b) {
  PairingOptions options;
  options.stride = 1;
  options.robust = false;
  return pair_motions(options, a, b).pairs.size();
}

TEST_F(LogTrajectoryTest, AnyFlippedBitOfOneTimeStampCostsAFewPairsAndIsReported) {
  const test::SmallLog log = test::small_log(path("good.log"), 600);
  const LogTrajectory left = read_log_trajectory(path("good.log"), "ODOMETRY_LEFT");
  const LogTrajectory right = read_log_trajectory(path("good.log"), "ODOMETRY_RIGHT_2");
  ASSERT_EQ(left.poses.size(), 600u);
  EXPECT_EQ(left.not_used, "");
  const std::size_t all = pairs_of(left.poses, right.poses);
  ASSERT_GT(all, 590u);

  for (const std::string& channel : {std::string("ODOMETRY_LEFT"), std::string("ODOMETRY_RIGHT_2")})
    for (int bit = 0; bit < 64; ++bit) {
      SCOPED_TRACE(channel + ", bit " + std::to_string(bit));
      // the sixtieth pose of the channel: its time is behind the fingerprint
      std::size_t event = 0, seen = 0;
      for (;; ++event) {
        const std::size_t name = log.begin[event] + test::log_header_size;
        if (log.bytes.compare(name, channel.size(), channel) == 0 && ++seen == 60) break;
      }
      std::string bytes = log.bytes;
      const std::size_t stamp = log.begin[event] + test::log_header_size + channel.size() + 8;
      bytes[stamp + static_cast<std::size_t>(7 - bit / 8)] ^= static_cast<char>(1 << bit % 8);
      test::write_bytes(path("damaged.log"), bytes);
      const LogTrajectory damaged = read_log_trajectory(path("damaged.log"), channel);
      EXPECT_GE(damaged.poses.size(), 599u);
      EXPECT_EQ(damaged.poses.size() < 600, !damaged.not_used.empty()) << damaged.not_used;
      const bool is_left = channel == "ODOMETRY_LEFT";
      EXPECT_GE(pairs_of(is_left ? damaged.poses : left.poses, is_left ? right.poses : damaged.poses) + 3,
                all);
    }
}

TEST_F(LogTrajectoryTest, ASecondSessionIsNotUsedAndReported) {
  {
    bus::LogWriter writer(path("twice.log"));
    for (int session = 0; session < 2; ++session)
      for (int i = 0; i < 300; ++i) {
        StampedPose pose;
        pose.time_us = 1'700'000'000'000'000 + 100'000 * i;
        writer.write(pose.time_us, "ODOMETRY", bus::encode(bus::to_message(pose, i)));
      }
    writer.close();
  }
  const LogTrajectory twice = read_log_trajectory(path("twice.log"), "ODOMETRY");
  EXPECT_EQ(twice.poses.size(), 300u);
  EXPECT_THAT(twice.not_used, HasSubstr("300 of 600 messages are used; 300 of a later session"));
}

/// Their senders fill in no time: that of recording is taken, unless other messages of the channel have one.
TEST_F(LogTrajectoryTest, MessagesWithoutATimeTakeThatOfRecording) {
  constexpr std::int64_t start = 1'700'000'000'000'000;
  const auto write = [&](bool some_have_one) {
    bus::LogWriter writer(path("zero.log"));
    for (int i = 0; i < 20; ++i) {
      StampedPose pose;
      pose.time_us = some_have_one && i % 2 == 0 ? start + 100'000 * i : 0;
      writer.write(start + 100'000 * i, "POSE", bus::encode(bus::to_pose_message(pose)));
    }
    writer.close();
  };
  write(false);
  const LogTrajectory all = read_log_trajectory(path("zero.log"), "POSE");
  ASSERT_EQ(all.poses.size(), 20u);
  EXPECT_EQ(all.poses[7].time_us, start + 700'000);
  EXPECT_EQ(all.not_used, "");
  EXPECT_EQ(all.times, "POSE: 20 messages have no time stamp: the time of recording was taken");
  write(true);
  const LogTrajectory some = read_log_trajectory(path("zero.log"), "POSE");
  EXPECT_EQ(some.poses.size(), 10u);
  EXPECT_THAT(some.not_used, HasSubstr("no time stamp, others of the channel have one"));
  EXPECT_EQ(some.times, "");
}

TEST_F(LogTrajectoryTest, AMissingChannelIsOneShortLineHoweverManyThereAre) {
  {
    bus::LogWriter writer(path("many.log"));
    StampedPose pose;
    pose.time_us = 1'700'000'000'000'000;
    for (int i = 0; i < 3000; ++i)
      writer.write(pose.time_us, "CHANNEL_" + std::string(40, 'x') + std::to_string(i),
                   bus::encode(bus::to_message(pose, i)));
    writer.close();
  }
  try {
    read_log_trajectory(path("many.log"), "ODOMETRY");
    FAIL();
  } catch (const Error& error) {
    EXPECT_LT(std::string(error.what()).size(), 1000u);
    EXPECT_THAT(error.what(), HasSubstr("CHANNEL_"));
  }
}

}  // namespace
}  // namespace egocal::tools::test_log_trajectory
