// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bags that are damaged, out of order, or lack what messages need: that costs what it held.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "../support/bag_drives.hpp"
#include "../support/bag_writer.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_bags_damaged {
namespace {

using testing::all_types;
using testing::expect_equal;
using ::testing::HasSubstr;
using testing::MessageEncoder;
using testing::pose_types;
using testing::some_trajectory;

TEST(Bags, MessagesWithoutAPoseAreCountedAndSkipped) {
  const testing::ScratchFolder folder;
  Trajectory trajectory = some_trajectory(30);
  auto messages = testing::as_messages(trajectory, "/odom", pose_types[0], MessageEncoder::Kind::cdr);
  messages[3].data.resize(40);
  MessageEncoder zero(MessageEncoder::Kind::cdr);
  messages[7].data = zero.header(trajectory[7].time_us, "odom").text("b").zeros(7 + 36 + 6 + 36).done();
  const TrajectoryReading reading =
      read_trajectory_file(folder.file("drive.mcap", testing::mcap_file(messages, {})));
  EXPECT_EQ(reading.trajectory.size(), 28u);
  EXPECT_EQ(reading.losses.refused, 2u);
  EXPECT_THAT(losses_in_words(reading.losses), HasSubstr("2 without a usable pose"));
}

/// Headers without a time: the time of recording, unless other messages of the topic have one.
TEST(Bags, MessagesWithoutAStampTakeTheTimeOfRecording) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(30);
  auto messages = testing::as_messages(trajectory, "/odom", pose_types[1], MessageEncoder::Kind::cdr);
  const auto unstamped = [&](std::size_t i) {
    return testing::encoded(MessageEncoder::Kind::cdr, pose_types[1], {0, trajectory[i].pose});
  };
  messages[0].data = unstamped(0);  // a simulation that begins at zero
  TrajectoryReading reading = read_trajectory_file(folder.file("a.mcap", testing::mcap_file(messages, {})));
  expect_equal(reading.trajectory, {trajectory.begin() + 1, trajectory.end()}, "one");
  EXPECT_EQ(reading.losses.refused, 1u);
  messages[1].data = unstamped(1);  // a driver that starts up: they had the times of recording
  reading = read_trajectory_file(folder.file("two.mcap", testing::mcap_file(messages, {})));
  expect_equal(reading.trajectory, {trajectory.begin() + 2, trajectory.end()}, "two");
  EXPECT_EQ(reading.losses.refused, 2u);
  // recorded as long after its time as the second one
  Trajectory from_zero = trajectory;
  for (std::size_t i = 0; i < from_zero.size(); ++i)
    from_zero[i].time_us = 100'000 * static_cast<std::int64_t>(i);
  reading = read_trajectory_file(folder.file(
      "z.mcap", testing::mcap_file(
                    testing::as_messages(from_zero, "/odom", pose_types[1], MessageEncoder::Kind::cdr), {})));
  expect_equal(reading.trajectory, from_zero, "from zero");
  EXPECT_FALSE(reading.losses.any());
  // the first of them was refused, and so was the bag by --strict: "others of the topic do"
  for (std::size_t i = 0; i < messages.size(); ++i) messages[i].data = unstamped(i);
  ReadOptions strict;
  strict.strict = true;
  reading = read_trajectory_file(folder.file("b.mcap", testing::mcap_file(messages, {})), strict);
  expect_equal(reading.trajectory, trajectory, "all");
  EXPECT_FALSE(reading.losses.any());
  EXPECT_THAT(reading.notes,
              ::testing::Contains(HasSubstr("30 messages have no time stamp in their header")));
  messages.resize(1);
  reading = read_trajectory_file(folder.file("c.mcap", testing::mcap_file(messages, {})));
  expect_equal(reading.trajectory, {trajectory.front()}, "the only one");
}

TEST(Bags, OrderIsRestoredAndCounted) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(30);
  Trajectory mixed = trajectory;
  std::swap(mixed[4], mixed[5]);
  mixed.push_back(trajectory[9]);
  const TrajectoryReading reading = read_trajectory_file(folder.file(
      "drive.bag",
      testing::rosbag1_file(testing::as_messages(mixed, "/odom", pose_types[1], MessageEncoder::Kind::ros1),
                            {"none"})));
  expect_equal(reading.trajectory, trajectory, "sorted");
  EXPECT_EQ(reading.out_of_order, 2u);
  EXPECT_EQ(reading.duplicates, 1u);
}

TEST(Bags, ADamagedChunkCostsWhatItHeld) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(500);
  const auto cdr = testing::as_messages(trajectory, "/odom", pose_types[0], MessageEncoder::Kind::cdr);
  // without a checksum only damaged lengths and quaternions show, so these messages hold little else
  const auto ros1 = testing::as_messages(trajectory, "/odom", pose_types[1], MessageEncoder::Kind::ros1);
  for (const std::string compression : {"", "lz4", "zstd", "none1", "lz41", "bz21"}) {
    const bool bag1 = compression.ends_with('1');
    const std::string name = bag1 ? compression.substr(0, compression.size() - 1) : compression;
    const std::string whole = bag1 ? testing::rosbag1_file(ros1, {name}) : testing::mcap_file(cdr, {name});
    std::string damaged = whole;
    // a block of a disk
    for (std::size_t i = whole.size() / 2; i < whole.size() / 2 + 512; ++i) damaged[i] = '\xa5';
    const TrajectoryReading reading = read_trajectory_file(folder.file("damaged", damaged));
    EXPECT_TRUE(reading.losses.any()) << compression;
    EXPECT_GE(reading.trajectory.size(), 390u) << compression;
    EXPECT_LT(reading.trajectory.size(), 500u) << compression;
    // a recorder that was killed
    const TrajectoryReading cut = read_trajectory_file(folder.file("cut", whole.substr(0, whole.size() / 2)));
    EXPECT_TRUE(cut.losses.truncated) << compression;
    EXPECT_GE(cut.trajectory.size(), 190u) << compression;
    // what is left is what was written
    std::size_t at = 0;
    for (const StampedPose& pose : cut.trajectory) {
      while (at < trajectory.size() && trajectory[at].time_us != pose.time_us) ++at;
      ASSERT_LT(at, trajectory.size());
      EXPECT_LT((pose.pose.vec() - trajectory[at].pose.vec()).norm(), 1e-12);
    }
  }
}

TEST(Bags, LengthsThatLieAskForNoMemory) {
  const testing::ScratchFolder folder;
  const std::string magic("\x89MCAP0\r\n", 8);
  const std::string files[] = {
      magic + '\6' + testing::little(1ull << 62, 8) + "abc",
      magic + testing::mcap_record(6, testing::little(1, 8) + testing::little(2, 8) +
                                          testing::little(1ull << 40, 8) + testing::little(0, 4) +
                                          testing::with_length("zstd") + testing::with_length("x") +
                                          std::string(4, '\0') + "x"),
      "#ROSBAG V2.0\n" + testing::little(0xffffffff, 4) + "abc",
      testing::rosbag1_file({}, {"none"}) +
          testing::rosbag1_record({{"op", "\5"}, {"compression", "lz4"}, {"size", "\xff\xff\xff\xff"}},
                                  "abc"),
  };
  for (const std::string& content : files) EXPECT_THROW(read_trajectory(folder.file("lies", content)), Error);
}

/// Of each kind of file. EGOCAL_DAMAGED_COPIES=2000 is the study (two minutes); the test is its first
/// seconds.
int damaged_copies() {
  const char* const given = std::getenv("EGOCAL_DAMAGED_COPIES");
  return given ? std::atoi(given) : 160;
}

/// No crash, no hang, no error but one line.
TEST(Bags, DamagedCopiesAreReadAsFarAsTheyGo) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(60);
  testing::write_db3(folder.path("whole.db3"), all_types(trajectory, MessageEncoder::Kind::cdr));
  std::ifstream database(folder.path("whole.db3"), std::ios::binary);
  const auto cdr = all_types(trajectory, MessageEncoder::Kind::cdr);
  const auto ros1 = all_types(trajectory, MessageEncoder::Kind::ros1);
  const std::string wholes[] = {
      testing::mcap_file(cdr, {"", 0}),          testing::mcap_file(cdr, {"", 20}),
      testing::mcap_file(cdr, {"lz4", 20}),      testing::mcap_file(cdr, {"zstd", 20}),
      testing::rosbag1_file(ros1, {"none", 20}), testing::rosbag1_file(ros1, {"bz2", 100}),
      testing::rosbag1_file(ros1, {"lz4", 20}),  {std::istreambuf_iterator<char>(database), {}}};
  testing::Random random(5);
  std::size_t readable = 0, copies = 0;
  for (const std::string& whole : wholes)
    for (int i = 0; i < damaged_copies(); ++i, ++copies) {
      std::string copy = whole;
      const int kind = i % 4;
      if (kind == 0) copy.resize(random.below(whole.size()));
      if (kind == 1) {
        const auto flipped = static_cast<char>(1 << random.below(8));
        copy[random.below(copy.size())] ^= flipped;
      }
      if (kind == 2)
        for (std::size_t at = random.below(copy.size()), n = 0; n < 200 && at < copy.size(); ++n, ++at)
          copy[at] = static_cast<char>(random.below(256));
      if (kind == 3) {
        const std::size_t count = 1 + random.below(1000);
        copy.erase(random.below(copy.size()), count);
      }
      try {
        const TrajectoryReading reading = read_trajectory_file(folder.file("copy", copy) + ":/Odometry");
        readable += reading.trajectory.size() > 5 ? 1 : 0;
        for (const StampedPose& pose : reading.trajectory) ASSERT_TRUE(pose.pose.vec().allFinite());
      } catch (const Error& error) {
        const std::string text = error.what();
        ASSERT_LT(text.size(), 1500u);
        ASSERT_EQ(text.find_first_of("\n\r\x1b"), std::string::npos) << text;
      }
    }
  EXPECT_GT(readable, copies / 2);
}

}  // namespace
}  // namespace egocal::test_io_bags_damaged
