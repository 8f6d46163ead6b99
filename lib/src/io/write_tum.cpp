// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cstdio>

#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal {

namespace {

/// The shortest text that reads back as the same double, whatever the locale.
void append(std::string& text, double value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace

void write_tum(const std::string& file, const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  char time[48];
  for (const StampedPose& stamped : trajectory) {
    const Pose pose = to_pose(stamped.pose);
    const Eigen::Vector3d& t = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    const std::int64_t magnitude = stamped.time_us < 0 ? -stamped.time_us : stamped.time_us;
    std::snprintf(time, sizeof time, "%s%lld.%06lld", stamped.time_us < 0 ? "-" : "",
                  static_cast<long long>(magnitude / 1'000'000),
                  static_cast<long long>(magnitude % 1'000'000));
    text += time;
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ';
      append(text, value);
    }
    text += '\n';
  }
  write_whole_file(file, text);
}

}  // namespace egocal
