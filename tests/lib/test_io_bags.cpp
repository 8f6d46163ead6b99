// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Bags of every kind: what was written is read, real ones hold what they are known to hold, and what is
// damaged costs what it held.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "../support/bag_writer.hpp"
#include "../support/paths.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_bags {
namespace {

using testing::BagOptions;
using ::testing::HasSubstr;
using testing::MessageEncoder;
using testing::WrittenMessage;

const std::string types[] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                             "geometry_msgs/PoseWithCovarianceStamped", "geometry_msgs/TransformStamped",
                             "tf2_msgs/TFMessage"};

Trajectory some_trajectory(int poses, std::uint64_t seed = 1) {
  testing::Random random(seed);
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i)
    trajectory.push_back({1'700'000'000'123'456 + 50'001 * i, testing::random_extrinsic(random)});
  return trajectory;
}

void expect_equal(const Trajectory& read, const Trajectory& written, const std::string& what) {
  ASSERT_EQ(read.size(), written.size()) << what;
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].time_us, written[i].time_us) << what << " pose " << i;
    ASSERT_LT((read[i].pose.vec() - written[i].pose.vec()).norm(), 1e-12) << what << " pose " << i;
  }
}

std::vector<WrittenMessage> all_types(const Trajectory& trajectory, MessageEncoder::Kind kind) {
  std::vector<WrittenMessage> messages;
  for (const std::string& type : types)
    for (WrittenMessage& message :
         testing::as_messages(trajectory, "/" + type.substr(type.find('/') + 1), type, kind))
      messages.push_back(std::move(message));
  messages.push_back({"/image", "sensor_msgs/Image", 1, std::string(5000, 'x')});
  return messages;
}

void expect_all_types(const std::string& file, const Trajectory& trajectory) {
  for (const std::string& type : types) {
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

// It was "which egocal reads no poses from", of a type that it reads.
TEST(Bags, AnEncodingThatIsNotKnownIsNamed) {
  const testing::ScratchFolder folder;
  BagOptions json;
  json.message_encoding = "json";
  const std::string file = folder.file(
      "json.mcap", testing::mcap_file(all_types(some_trajectory(20), MessageEncoder::Kind::cdr), json));
  std::string refusal;
  try {
    read_trajectory(file + ":/Odometry");
  } catch (const Error& error) {
    refusal = error.what();
  }
  EXPECT_THAT(refusal, HasSubstr("is of type nav_msgs/Odometry in the encoding json, expected cdr or ros1"));
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
    return testing::as_messages({trajectory.begin() + first, trajectory.begin() + last}, "/odom", types[0],
                                MessageEncoder::Kind::cdr);
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
  const auto messages = testing::as_messages(trajectory, "/odom", types[0], MessageEncoder::Kind::cdr);
  const std::string file = testing::mcap_file(messages, {});
  expect_equal(read_trajectory(folder.file("drive.mcap.zstd", testing::packed("zstd", file))), trajectory,
               "zstd");
  write_tum(folder.path("a.tum"), trajectory);
  ASSERT_EQ(std::system(("gzip -k " + folder.path("a.tum")).c_str()), 0);
  expect_equal(read_trajectory(folder.path("a.tum.gz")), trajectory, "gzip");
}

TEST(Bags, ChainsOfTransformsAreResolvedByTime) {
  const testing::ScratchFolder folder;
  // map -> odom at 1 Hz, odom -> base at 20 Hz, base -> lidar static: the chain has the times of the fastest
  testing::Random random(3);
  const DualQuaternion mount = testing::random_extrinsic(random);
  const auto drift = [](std::int64_t t) {
    return to_dual_quaternion({rotation_exp({0, 0, 1e-8 * static_cast<double>(t)}), {0, 0, 0}});
  };
  const auto drive = [](std::int64_t t) {
    return to_dual_quaternion(
        {rotation_exp({0, 0, 2e-7 * static_cast<double>(t)}), {1e-6 * static_cast<double>(t), 0, 0}});
  };
  const auto transform = [](const std::string& topic, const std::string& parent, const std::string& child,
                            std::int64_t t, const DualQuaternion& pose) {
    MessageEncoder to(MessageEncoder::Kind::cdr);
    return WrittenMessage{topic, "tf2_msgs/TFMessage", t,
                          to.u32(1).header(t, parent).text(child).pose(pose).done()};
  };
  constexpr std::int64_t start = 1'700'000'000'000'000;
  std::vector<WrittenMessage> messages{transform("/tf_static", "base", "lidar", start, mount)};
  for (std::int64_t t = 0; t <= 10'000'000; t += 50'000) {
    if (t % 1'000'000 == 0) messages.push_back(transform("/tf", "/map", "odom", start + t, drift(t)));
    messages.push_back(transform("/tf", "odom", "base", start + t, drive(t)));
  }
  const std::string file = folder.file("tf.mcap", testing::mcap_file(messages, {}));
  const Trajectory forward = read_trajectory(file + ":/tf:map/lidar");
  ASSERT_EQ(forward.size(), 201u);
  for (const StampedPose& stamped : forward) {
    const DualQuaternion expected = drift(stamped.time_us - start) * drive(stamped.time_us - start) * mount;
    EXPECT_LT((canonical_sign(stamped.pose).vec() - canonical_sign(expected).vec()).norm(), 1e-9);
  }
  const Trajectory backward = read_trajectory(file + ":/tf:lidar/map");
  ASSERT_EQ(backward.size(), 201u);
  EXPECT_LT((canonical_sign(backward[7].pose * forward[7].pose).vec() - DualQuaternion{}.vec()).norm(), 1e-9);
  EXPECT_THROW(read_trajectory(file + ":/tf:base/lidar"), Error);  // static: nothing moves
  EXPECT_THROW(read_trajectory(file + ":/tf:map/nowhere"), Error);
}

TEST(Bags, WithoutATopicThePossibleOnesAreNamed) {
  const testing::ScratchFolder folder;
  const auto messages = all_types(some_trajectory(20), MessageEncoder::Kind::cdr);
  const std::string file = folder.file("drive.mcap", testing::mcap_file(messages, {}));
  for (const std::string& name : {file, file + ":/nonsense", file + ":/image"}) try {
      read_trajectory(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("/Odometry (nav_msgs/Odometry, 20)"));
      EXPECT_THAT(error.what(), HasSubstr("/TFMessage:odom/base/link (20)"));
      EXPECT_THAT(error.what(), HasSubstr(file));
    }
  const auto only_images = std::vector<WrittenMessage>{messages.back()};
  try {
    read_trajectory(folder.file("images.mcap", testing::mcap_file(only_images, {})));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no topic with poses, 1 others"));
  }
}

TEST(Bags, MessagesWithoutAPoseAreCountedAndSkipped) {
  const testing::ScratchFolder folder;
  Trajectory trajectory = some_trajectory(30);
  auto messages = testing::as_messages(trajectory, "/odom", types[0], MessageEncoder::Kind::cdr);
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
  auto messages = testing::as_messages(trajectory, "/odom", types[1], MessageEncoder::Kind::cdr);
  const auto unstamped = [&](std::size_t i) {
    return testing::encoded(MessageEncoder::Kind::cdr, types[1], {0, trajectory[i].pose});
  };
  messages[0].data = unstamped(0);  // a simulation that begins at zero
  TrajectoryReading reading = read_trajectory_file(folder.file("a.mcap", testing::mcap_file(messages, {})));
  expect_equal(reading.trajectory, {trajectory.begin() + 1, trajectory.end()}, "one");
  EXPECT_EQ(reading.losses.refused, 1u);
  // recorded as long after its time as the second one
  Trajectory from_zero = trajectory;
  for (std::size_t i = 0; i < from_zero.size(); ++i)
    from_zero[i].time_us = 100'000 * static_cast<std::int64_t>(i);
  reading = read_trajectory_file(folder.file(
      "z.mcap",
      testing::mcap_file(testing::as_messages(from_zero, "/odom", types[1], MessageEncoder::Kind::cdr), {})));
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

std::string refusal_of(const std::string& name) {
  try {
    read_trajectory(name);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << name << " was read";
  return "";
}

/// "is of type tf2_msgs/TFMessage, which egocal reads no poses from" was said of what it reads poses from.
TEST(Bags, OfSeveralTransformsOneIsAskedFor) {
  const testing::ScratchFolder folder;
  std::vector<WrittenMessage> messages;
  for (const auto& [topic, child] :
       {std::pair{"/tf", "base"}, std::pair{"/tf", "camera"}, std::pair{"/tf_static", "mast"}})
    for (const StampedPose& pose : some_trajectory(3)) {
      MessageEncoder to(MessageEncoder::Kind::cdr);
      messages.push_back({topic, "tf2_msgs/TFMessage", pose.time_us,
                          to.u32(1).header(pose.time_us, "odom").text(child).pose(pose.pose).done()});
    }
  const std::string file = folder.file("tf.mcap", testing::mcap_file(messages, {}));
  EXPECT_THAT(refusal_of(file + ":/tf"),
              HasSubstr("/tf: holds 2 transforms that move: choose one with /tf:PARENT/CHILD; topics with "
                        "poses: /tf:odom/base (3), /tf:odom/camera (3)"));
  EXPECT_THAT(refusal_of(file + ":/tf_static"), HasSubstr("static transforms alone: nothing moves"));
}

/// A colon was taken for the end of a tf topic's name, and letters beyond ASCII were printed as ??.
TEST(Bags, TopicsMayHaveColonsAndAnyLetters) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(20);
  std::vector<WrittenMessage> messages;
  for (const char* topic : {"/vo:odom", "/lidar \xc3\xbc", "/broken \xc3"})
    for (WrittenMessage& message :
         testing::as_messages(trajectory, topic, types[0], MessageEncoder::Kind::cdr))
      messages.push_back(std::move(message));
  const std::string file = folder.file("names.mcap", testing::mcap_file(messages, {}));
  for (const char* topic : {":/vo:odom", ":vo:odom", ":/lidar \xc3\xbc"})
    expect_equal(read_trajectory(file + topic), trajectory, topic);
  EXPECT_THAT(refusal_of(file + ":/none"),
              HasSubstr("topics with poses: /vo:odom (nav_msgs/Odometry, 20), /lidar \xc3\xbc "
                        "(nav_msgs/Odometry, 20), /broken ? (nav_msgs/Odometry, 20)"));
}

/// "no pose under this name; topics with poses: /odom (nav_msgs/Odometry, 0)".
TEST(Bags, ATopicWithoutMessagesIsSaidToHaveNone) {
  const testing::ScratchFolder folder;
  const std::string magic("\x89MCAP0\r\n", 8);
  const std::string file = folder.file(
      "empty.mcap",
      magic + testing::mcap_record(1, testing::with_length("ros2") + testing::with_length("")) +
          testing::mcap_record(3, testing::little(1, 2) + testing::with_length("nav_msgs/msg/Odometry") +
                                      testing::with_length("ros2msg") + testing::with_length("")) +
          testing::mcap_record(4, testing::little(0, 2) + testing::little(1, 2) +
                                      testing::with_length("/odom") + testing::with_length("cdr") +
                                      testing::little(0, 4)) +
          testing::mcap_record(15, testing::little(0, 4)) + testing::mcap_record(2, std::string(20, '\0')) +
          magic);
  for (const char* topic : {":/odom", ":odom"})
    EXPECT_THAT(refusal_of(file + topic),
                HasSubstr("/odom: this topic has no messages; there is no topic with "
                          "poses, 1 that may hold them have no messages, 0 others"));
}

TEST(Bags, OrderIsRestoredAndCounted) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(30);
  Trajectory mixed = trajectory;
  std::swap(mixed[4], mixed[5]);
  mixed.push_back(trajectory[9]);
  const TrajectoryReading reading = read_trajectory_file(
      folder.file("drive.bag",
                  testing::rosbag1_file(
                      testing::as_messages(mixed, "/odom", types[1], MessageEncoder::Kind::ros1), {"none"})));
  expect_equal(reading.trajectory, trajectory, "sorted");
  EXPECT_EQ(reading.out_of_order, 2u);
  EXPECT_EQ(reading.duplicates, 1u);
}

TEST(Bags, ADamagedChunkCostsWhatItHeld) {
  const testing::ScratchFolder folder;
  const Trajectory trajectory = some_trajectory(500);
  const auto cdr = testing::as_messages(trajectory, "/odom", types[0], MessageEncoder::Kind::cdr);
  // without a checksum only damaged lengths and quaternions show, so these messages hold little else
  const auto ros1 = testing::as_messages(trajectory, "/odom", types[1], MessageEncoder::Kind::ros1);
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
