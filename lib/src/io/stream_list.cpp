// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/stream_list.hpp"

#include <string_view>

#include "egocal/printable.hpp"

namespace egocal::detail {

namespace {

/// What people take for an odometry, and what to do about it.
struct OtherType {
  std::string_view type, problem;
};
constexpr OtherType other_types[] = {
    {"nav_msgs/Path", "which repeats a whole path in every message: record the odometry it is made of"},
    {"geometry_msgs/Pose", "which has no time: record a PoseStamped"},
    {"geometry_msgs/PoseArray", "which holds poses of several things: record a PoseStamped of one"},
    {"geometry_msgs/Twist", "which has no time: record a TwistStamped, or the odometry"},
    {"sensor_msgs/NavSatFix", "which has no orientation: record the pose of the GNSS/INS filter"},
    {"sensor_msgs/Imu", "which has no position: run an odometry with it and record that"},
    {"sensor_msgs/PointCloud2", "which is no pose: run an odometry on it and record that"},
    {"sensor_msgs/LaserScan", "which is no pose: run an odometry on it and record that"},
    {"sensor_msgs/Image", "which is no pose: run an odometry on it and record that"},
    {"sensor_msgs/CompressedImage", "which is no pose: run an odometry on it and record that"}};

constexpr std::size_t longest_type = 60;  // limit of what people read [bytes]

/// Why a topic with transforms, each of which is a stream of its own, has no poses; empty: it is another
/// topic.
std::string why_no_transform(const std::vector<RecordedStream>& streams, const RecordedStream& topic) {
  std::size_t moving = 0, fixed = 0;
  for (const RecordedStream& stream : streams)
    if (stream.topic == topic.topic && stream.name != stream.topic) ++(stream.fixed ? fixed : moving);
  if (moving > 0)
    return "holds " + std::to_string(moving) + " transforms that move: choose one with " +
           printable(topic.topic) + ":PARENT/CHILD";
  return fixed > 0 ? "holds static transforms alone: nothing moves" : "";
}

}  // namespace

std::string why_no_poses(const std::vector<RecordedStream>& streams, const std::string& name) {
  if (name.empty()) return {};
  for (const RecordedStream& stream : streams) {
    if (stream.type.empty() || (stream.name != name && stream.name != "/" + name)) continue;
    if (stream.messages == 0) return "this topic has no messages";
    if (stream.fixed) return "is a static transform: it never moves";
    if (stream.poses) return "none of its messages holds a pose that can be used";
    if (std::string text = why_no_transform(streams, stream); !text.empty()) return text;
    std::string text = "is of type " + printable(stream.type, longest_type);
    if (!stream.unknown_encoding.empty())
      return text + " in the encoding " + printable(stream.unknown_encoding, longest_type) +
             ", expected cdr or ros1";
    for (const OtherType& other : other_types)
      if (stream.type == other.type) return text + ", " + std::string(other.problem);
    return text + ", which egocal reads no poses from";
  }
  return {};
}

std::string topics_in_words(const std::vector<RecordedStream>& streams) {
  constexpr std::size_t longest = 500;  // bytes of a message
  std::string text;
  std::size_t poses = 0, left_away = 0, others = 0, without_messages = 0;
  for (const RecordedStream& stream : streams) {
    if (stream.poses && stream.messages == 0) {
      ++without_messages;
      continue;
    }
    if (!stream.poses || stream.fixed) {
      others += stream.name == stream.topic && !stream.poses ? 1 : 0;
      continue;
    }
    ++poses;
    if (text.size() > longest) {
      ++left_away;
      continue;
    }
    const bool transform = stream.name != stream.topic;
    text += (text.empty() ? "" : ", ") + printable(stream.name) + " (" +
            (transform ? "" : printable(stream.type, longest_type) + ", ") + std::to_string(stream.messages) +
            ")";
  }
  if (poses == 0)
    return "there is no topic with poses, " +
           (without_messages > 0 ? std::to_string(without_messages) + " that may hold them have no messages, "
                                 : std::string()) +
           std::to_string(others) +
           " others (see egocal info FILE; expected nav_msgs/Odometry, geometry_msgs/PoseStamped, "
           "PoseWithCovarianceStamped, TransformStamped or tf2_msgs/TFMessage)";
  if (left_away > 0) text += " and " + std::to_string(left_away) + " more (see egocal info FILE)";
  return "topics with poses: " + text;
}

}  // namespace egocal::detail
