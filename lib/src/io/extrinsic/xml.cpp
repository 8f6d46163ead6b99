// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

namespace {

/// Two hyphens would end an XML comment: "--invert-b" becomes "- -invert-b".
std::string comment(std::string text) {
  for (std::size_t at; (at = text.find("--")) != std::string::npos;) text.insert(at + 1, " ");
  return "<!-- " + text + " -->\n";
}

std::string described(const ExtrinsicWords& words, const std::string& indent = "") {
  return indent +
         comment("parent " + words.a + ", child " + words.b + ": pose of the child in the parent, " +
                 words.lengths + ", radians; quaternion w x y z: " + joined(wxyz(words.T.rotation), " ")) +
         indent + comment(words.verdict);
}

}  // namespace

std::string urdf_text(const ExtrinsicWords& words) {
  return described(words) + "<joint name=\"" + words.a + "_to_" + words.b +
         "\" type=\"fixed\">\n  <parent link=\"" + words.a + "\"/>\n  <child link=\"" + words.b +
         "\"/>\n  <origin xyz=\"" + joined(words.T.translation, " ") + "\" rpy=\"" +
         joined(roll_pitch_yaw(words.T.rotation), " ") + "\"/>\n</joint>\n";
}

std::string ros_launch_text(const ExtrinsicWords& words) {
  return "<launch>\n" + ros_launch_node(words) + "</launch>\n";
}

std::string ros_launch_node(const ExtrinsicWords& words) {
  const Eigen::Quaterniond& q = words.T.rotation;
  const Eigen::Vector3d& t = words.T.translation;
  std::string node;  // names of nodes take letters, digits and _
  for (const char c : words.a + "_to_" + words.b) node += c == '-' || c == '.' || c == '/' ? '_' : c;
  return described(words, "  ") + "  <node pkg=\"tf2_ros\" exec=\"static_transform_publisher\" name=\"" +
         node + "\"\n        args=\"--x " + exact(t.x()) + " --y " + exact(t.y()) + " --z " + exact(t.z()) +
         " --qx " + exact(q.x()) + " --qy " + exact(q.y()) + " --qz " + exact(q.z()) + " --qw " +
         exact(q.w()) + " --frame-id " + words.a + " --child-frame-id " + words.b + "\"/>\n";
}

}  // namespace egocal::detail
