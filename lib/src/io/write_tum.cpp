// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"
#include "io/number_text.hpp"

namespace egocal {

void write_tum(const std::string& file, const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    const Pose pose = to_pose(stamped.pose);
    const Eigen::Vector3d& t = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    detail::append_seconds(text, stamped.time_us);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ';
      detail::append_number(text, value);
    }
    text += '\n';
  }
  write_whole_file(file, text);
}

}  // namespace egocal
