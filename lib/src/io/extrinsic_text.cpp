// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/extrinsic_text.hpp"

#include <cmath>

#include "egocal/error.hpp"
#include "io/number_text.hpp"

namespace egocal {
namespace {

std::string exact(double value) {
  std::string text;
  detail::append_number(text, value == 0 ? 0.0 : value);
  // YAML 1.1 takes 1e-05 for a word, 1.0e-05 for a number
  if (const auto e = text.find('e'); e != std::string::npos && text.find('.') == std::string::npos)
    text.insert(e, ".0");
  return text;
}

template <typename Vector>
std::string joined(const Vector& values, const char* separator) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) text += (i ? separator : "") + exact(values(i));
  return text;
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

// Frame names come from the wire: nothing in them may end a quote, a comment or a line.
std::string frame_name(const std::string& name) {
  std::string safe;
  for (char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || c == '.' || c == '/';
    safe += plain ? c : '_';
    if (safe.size() == 100) break;
  }
  return safe.empty() ? "unnamed" : safe;
}

std::string matrix_rows(const Pose& T, const std::string& indent) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector4d row(R(i, 0), R(i, 1), R(i, 2), T.translation(i));
    text += indent + "- [" + joined(row, ", ") + "]\n";
  }
  return text + indent + "- [0, 0, 0, 1]\n";
}

}  // namespace

std::string_view name(ExtrinsicFormat format) {
  switch (format) {
    case ExtrinsicFormat::yaml:
      return "yaml";
    case ExtrinsicFormat::ros:
      return "ros";
    case ExtrinsicFormat::urdf:
      return "urdf";
    case ExtrinsicFormat::kalibr:
      return "kalibr";
  }
  return "";
}

std::optional<ExtrinsicFormat> extrinsic_format_from_name(std::string_view text) {
  for (ExtrinsicFormat format :
       {ExtrinsicFormat::yaml, ExtrinsicFormat::ros, ExtrinsicFormat::urdf, ExtrinsicFormat::kalibr})
    if (name(format) == text) return format;
  return std::nullopt;
}

std::string extrinsic_text(const NamedExtrinsic& extrinsic, ExtrinsicFormat format) {
  const Pose& T = extrinsic.T_parent_child;
  if (!T.translation.allFinite() || !T.rotation.coeffs().allFinite())
    throw Error("no extrinsic of " + frame_name(extrinsic.child) + " in " + frame_name(extrinsic.parent) +
                " to write: its values are not finite");
  const std::string a = frame_name(extrinsic.parent), b = frame_name(extrinsic.child);
  const std::string direction = "pose of " + b + " in " + a + ": p_" + a + " = R * p_" + b + " + t";
  const std::string verdict =
      std::string(extrinsic.certified ? "certified globally optimal" : "not certified") + ", from " +
      std::to_string(extrinsic.pairs) + " motion pairs";
  std::string text;
  switch (format) {
    case ExtrinsicFormat::yaml: {
      text += "# " + direction + "\n# metres, radians, quaternion order w x y z\n";
      text += "parent: " + a + "\nchild: " + b + "\n";
      text += "translation: [" + joined(T.translation, ", ") + "]\n";
      text += "rotation_wxyz: [" + joined(wxyz(T.rotation), ", ") + "]\n";
      text += "roll_pitch_yaw: [" + joined(roll_pitch_yaw(T.rotation), ", ") + "]\n";
      text += "matrix:\n" + matrix_rows(T, "  ");
      if (extrinsic.stddev) {
        text += "stddev:  # x y z roll pitch yaw in " + a + "; .inf: the motions do not show it\n";
        for (double s : *extrinsic.stddev)
          text +=
              "  - " + (std::isfinite(s) ? exact(s) : std::string(std::isnan(s) ? ".nan" : ".inf")) + "\n";
      }
      text += std::string("certified: ") + (extrinsic.certified ? "true" : "false") + "\n";
      text += "pairs: " + std::to_string(extrinsic.pairs) + "\n";
      break;
    }
    case ExtrinsicFormat::ros: {
      const Eigen::Quaterniond& q = T.rotation;
      text += "# " + direction + "; " + verdict + "\n# parent " + a + ", child " + b +
              ", metres, quaternion by name\n";
      text += "ros2 run tf2_ros static_transform_publisher --x " + exact(T.translation.x()) + " --y " +
              exact(T.translation.y()) + " --z " + exact(T.translation.z()) + " --qx " + exact(q.x()) +
              " --qy " + exact(q.y()) + " --qz " + exact(q.z()) + " --qw " + exact(q.w()) + " --frame-id " +
              a + " --child-frame-id " + b + "\n";
      text += "# ROS 1 (x y z qx qy qz qw parent child):\n# rosrun tf2_ros static_transform_publisher " +
              joined(T.translation, " ") + " " + joined(Eigen::Vector4d(q.x(), q.y(), q.z(), q.w()), " ") +
              " " + a + " " + b + "\n";
      break;
    }
    case ExtrinsicFormat::urdf:
      // two hyphens would end an XML comment
      text += "<!-- parent " + a + ", child " + b +
              ": pose of the child in the parent, metres, radians; quaternion w x y z: " +
              joined(wxyz(T.rotation), " ") + "; " + verdict + " -->\n";
      for (std::size_t at; (at = text.find("--", 4)) != std::string::npos && at + 4 < text.size();)
        text.replace(at, 2, "__");
      text += "<joint name=\"" + a + "_to_" + b + "\" type=\"fixed\">\n  <parent link=\"" + a +
              "\"/>\n  <child link=\"" + b + "\"/>\n  <origin xyz=\"" + joined(T.translation, " ") +
              "\" rpy=\"" + joined(roll_pitch_yaw(T.rotation), " ") + "\"/>\n</joint>\n";
      break;
    case ExtrinsicFormat::kalibr: {
      const Pose inverted = inverse(T);
      text += "# Kalibr's T_cam_imu takes points of the imu frame into the camera frame: p_" + b +
              " = T_cam_imu * p_" + a + ",\n";
      text += "# so it is the inverse of the pose of " + b + " in " + a + ". imu (parent): " + a +
              ", cam0 (child): " + b + ".\n";
      text += "# metres; the rotation as quaternion w x y z: [" + joined(wxyz(inverted.rotation), ", ") +
              "]; " + verdict + "\n";
      text += "cam0:\n  T_cam_imu:\n" + matrix_rows(inverted, "  ");
      break;
    }
  }
  return text;
}

}  // namespace egocal
