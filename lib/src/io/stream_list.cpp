// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/stream_list.hpp"

#include <string_view>

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

}  // namespace

std::string why_no_poses(const std::vector<RecordedStream>& streams, const std::string& name) {
  if (name.empty()) return {};
  for (const RecordedStream& stream : streams) {
    if (stream.poses || stream.type.empty() || (stream.name != name && stream.name != "/" + name)) continue;
    std::string text = "is of type " + printable(stream.type).substr(0, 60);
    for (const OtherType& other : other_types)
      if (stream.type == other.type) return text + ", " + std::string(other.problem);
    return text + ", which egocal reads no poses from";
  }
  return {};
}

std::string printable(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code > 0x7e ? '?' : c;
    if (out.size() == 200) break;
  }
  return out;
}

std::string topics_in_words(const std::vector<RecordedStream>& streams) {
  constexpr std::size_t longest = 500;  // bytes of a message
  std::string text;
  std::size_t poses = 0, left_away = 0, others = 0;
  for (const RecordedStream& stream : streams) {
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
            (transform ? "" : printable(stream.type).substr(0, 60) + ", ") + std::to_string(stream.messages) +
            ")";
  }
  if (poses == 0)
    return "there is no topic with poses, " + std::to_string(others) +
           " others (see egocal info FILE; expected nav_msgs/Odometry, geometry_msgs/PoseStamped, "
           "PoseWithCovarianceStamped, TransformStamped or tf2_msgs/TFMessage)";
  if (left_away > 0) text += " and " + std::to_string(left_away) + " more (see egocal info FILE)";
  return "topics with poses: " + text;
}

}  // namespace egocal::detail
