// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which topic of a bag, or which transform of it, is read, and what is said where there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "../support/bag_drives.hpp"
#include "../support/bag_writer.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_bag_topics {
namespace {

using testing::all_types;
using testing::BagOptions;
using testing::expect_equal;
using ::testing::HasSubstr;
using testing::MessageEncoder;
using testing::pose_types;
using testing::refusal_of;
using testing::some_trajectory;
using testing::WrittenMessage;

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
         testing::as_messages(trajectory, topic, pose_types[0], MessageEncoder::Kind::cdr))
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

}  // namespace
}  // namespace egocal::test_io_bag_topics
