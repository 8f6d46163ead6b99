// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Recordings that say one thing in two ways: one is taken, a note names it, and --strict refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/bag_writer.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_contradictions {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageEncoder;
using testing::WrittenMessage;

constexpr std::int64_t start = 1'700'000'000'000'000;  // [us]

DualQuaternion mount(double angle, double x) {
  return to_dual_quaternion({rotation_exp({0, 0, angle}), {x, 0, 0}});
}

DualQuaternion place(std::int64_t i) {
  return mount(0.01 * static_cast<double>(i), 0.1 * static_cast<double>(i));
}

class Contradictions : public ::testing::Test {
 protected:
  static WrittenMessage transform(const std::string& topic, const std::string& parent,
                                  const std::string& child, std::int64_t time_us,
                                  const DualQuaternion& pose) {
    MessageEncoder to(MessageEncoder::Kind::cdr);
    return {topic, "tf2_msgs/TFMessage", time_us,
            to.u32(1).header(time_us, parent).text(child).pose(pose).done()};
  }
  /// A hundred poses of base in odom, at 10 Hz.
  static std::vector<WrittenMessage> drive() {
    std::vector<WrittenMessage> messages;
    for (std::int64_t i = 0; i < 100; ++i)
      messages.push_back(transform("/tf", "odom", "base", start + 100'000 * i, place(i)));
    return messages;
  }
  static WrittenMessage pose(const std::string& type, std::int64_t i, const std::string& parent,
                             const std::string& child) {
    const std::int64_t time_us = start + 100'000 * i;
    MessageEncoder to(MessageEncoder::Kind::cdr);
    to.header(time_us, parent);
    if (type != "geometry_msgs/PoseStamped") to.text(child);
    to.pose(place(i));
    if (type == "nav_msgs/Odometry") to.zeros(36 + 6 + 36);
    return {"/p", type, time_us, to.done()};
  }
  std::string file(const std::vector<WrittenMessage>& messages) const {
    return folder_.file("drive.mcap", testing::mcap_file(messages, {}));
  }
  static std::string refusal(const std::string& name, bool strict) {
    ReadOptions options;
    options.strict = strict;
    try {
      read_trajectory_file(name, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  testing::ScratchFolder folder_;
};

TEST_F(Contradictions, AStaticTransformThatChangesIsNoted) {
  auto messages = drive();
  messages.insert(messages.begin(), transform("/tf_static", "base", "cam", start, mount(0.1, 1)));
  messages.insert(messages.begin() + 60,
                  transform("/tf_static", "base", "cam", start + 5'900'000, mount(1.1, 1.5)));
  const std::string name = file(messages) + ":/tf:odom/cam";
  const TrajectoryReading reading = read_trajectory_file(name);
  ASSERT_EQ(reading.trajectory.size(), 100u);
  // as in tf2: the newest one, for all time
  EXPECT_LT((reading.trajectory[0].pose.vec() - mount(1.1, 1.5).vec()).norm(), 1e-9);
  EXPECT_THAT(reading.notes,
              Contains(HasSubstr("the static transform base to cam changes at 1700000005.900 s "
                                 "by 57.296 deg and 0.5000 m: its last value is used for the "
                                 "whole drive")));
  EXPECT_THAT(refusal(name, true), HasSubstr("base to cam changes"));
}

TEST_F(Contradictions, AStaticTransformThatIsRepeatedIsNoContradiction) {
  auto messages = drive();
  for (std::int64_t i = 0; i < 5; ++i)  // one sender rounds to six digits
    messages.insert(messages.begin() + 20 * i,
                    transform("/tf_static", "base", "cam", start + i, mount(0.1, 1 + (i == 2 ? 4e-7 : 0))));
  const TrajectoryReading reading = read_trajectory_file(file(messages) + ":/tf:odom/cam");
  EXPECT_THAT(reading.contradictions, IsEmpty());
  EXPECT_THAT(reading.notes, IsEmpty());
}

TEST_F(Contradictions, AStaticTransformOfAnotherTopicMustBeTheSame) {
  auto messages = drive();
  messages.push_back(transform("/tf_static", "base", "cam", start, mount(0.1, 1)));
  messages.push_back(transform("/robot/tf_static", "cam", "base", start, conjugate(mount(0.1, 1))));
  EXPECT_EQ(refusal(file(messages) + ":/tf:odom/cam", true), "accepted");
  messages.push_back(transform("/robot/tf_static", "base", "cam", start, mount(0.1, 2)));
  EXPECT_THAT(
      refusal(file(messages) + ":/tf:odom/cam", true),
      AllOf(HasSubstr("is another one on /robot/tf_static"), HasSubstr("that of /tf_static is used")));
}

TEST_F(Contradictions, FramesThatAreMixedOnOneTopicAreCounted) {
  for (const std::string type :
       {"geometry_msgs/PoseStamped", "nav_msgs/Odometry", "geometry_msgs/TransformStamped"}) {
    const bool two_parents = type == "geometry_msgs/PoseStamped";
    std::vector<WrittenMessage> messages;
    for (std::int64_t i = 0; i < 30; ++i)
      messages.push_back(pose(type, i, two_parents && i % 3 == 0 ? "/map" : "odom",
                              !two_parents && i % 3 == 0 ? "lidar" : "cam"));
    const std::string name = file(messages) + ":/p";
    const TrajectoryReading reading = read_trajectory_file(name);
    EXPECT_EQ(reading.trajectory.size(), 30u);
    const std::string expected = "/p: poses of several frames are mixed: ";
    const std::string counts = two_parents ? "map (10), odom (20)" : "odom to lidar (10), odom to cam (20)";
    EXPECT_THAT(reading.notes, Contains(HasSubstr(expected + counts))) << type;
    EXPECT_THAT(refusal(name, true), HasSubstr(expected)) << type;
    // the same frame, with tf1's slash and without
    messages.clear();
    for (std::int64_t i = 0; i < 30; ++i)
      messages.push_back(pose(type, i, i % 2 == 0 ? "/odom" : "odom", "cam"));
    EXPECT_EQ(refusal(file(messages) + ":/p", true), "accepted") << type;
  }
}

TEST_F(Contradictions, TypesThatAreMixedOnOneTopicAreCounted) {
  std::vector<WrittenMessage> messages;
  for (std::int64_t i = 0; i < 30; ++i)
    messages.push_back(
        pose(i % 3 == 0 ? "geometry_msgs/PoseStamped" : "nav_msgs/Odometry", i, "odom", "cam"));
  const std::string name = file(messages) + ":/p";
  const std::string expected = "/p: messages of several types are mixed: ";
  EXPECT_THAT(read_trajectory_file(name).notes,
              Contains(HasSubstr(expected + "geometry_msgs/PoseStamped (10), nav_msgs/Odometry (20)")));
  EXPECT_THAT(refusal(name, true), HasSubstr(expected));
}

TEST_F(Contradictions, ATopicOfAnotherTypeIsNamedAsOne) {
  auto messages = drive();
  for (const auto& [type, cure] :
       {std::pair<std::string, std::string>{"nav_msgs/Path", "record the odometry"},
        {"geometry_msgs/Pose", "record a PoseStamped"},
        {"geometry_msgs/Twist", "record a TwistStamped"},
        {"sensor_msgs/NavSatFix", "no orientation"},
        {"sensor_msgs/Imu", "no position"},
        {"my_msgs/Thing", "reads no poses from"}}) {
    messages.push_back({"/other", type, start, "xxxx"});
    EXPECT_THAT(refusal(file(messages) + ":other", false),
                AllOf(HasSubstr("is of type " + type), HasSubstr(cure)));
    EXPECT_THAT(refusal(file(messages) + ":/nowhere", false), HasSubstr("no pose under this name"));
    messages.pop_back();
  }
}

}  // namespace
}  // namespace egocal::test_io_contradictions
