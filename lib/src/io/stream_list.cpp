// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/stream_list.hpp"

#include <algorithm>

namespace egocal::detail {

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
