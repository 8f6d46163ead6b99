// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string ros_text(const ExtrinsicWords& words) {
  const Eigen::Quaterniond& q = words.T.rotation;
  const Eigen::Vector3d& t = words.T.translation;
  std::string text = "# " + words.direction + "\n# " + words.verdict + "\n# parent " + words.a + ", child " +
                     words.b + ", " + words.lengths + ", quaternion by name\n";
  text += "ros2 run tf2_ros static_transform_publisher --x " + exact(t.x()) + " --y " + exact(t.y()) +
          " --z " + exact(t.z()) + " --qx " + exact(q.x()) + " --qy " + exact(q.y()) + " --qz " +
          exact(q.z()) + " --qw " + exact(q.w()) + " --frame-id " + words.a + " --child-frame-id " + words.b +
          "\n";
  return text + "# ROS 1 (x y z qx qy qz qw parent child):\n# rosrun tf2_ros static_transform_publisher " +
         joined(t, " ") + " " + joined(xyzw(q), " ") + " " + words.a + " " + words.b + "\n";
}

}  // namespace egocal::detail
