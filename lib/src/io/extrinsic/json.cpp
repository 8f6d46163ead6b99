// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <initializer_list>

#include "io/extrinsic/words.hpp"

namespace egocal::detail {

namespace {

std::string named(std::initializer_list<const char*> names, const double* values) {
  std::string text = "{";
  for (const char* name : names) {
    const double value = *values++;
    text += std::string(text.size() > 1 ? ", " : "") + "\"" + name +
            "\": " + (std::isfinite(value) ? exact(value) : "null");
  }
  return text + "}";
}

std::string pose_json(const Pose& T) {
  const Eigen::Vector4d q = wxyz(T.rotation);
  const Eigen::Vector3d angles = roll_pitch_yaw(T.rotation);
  const Eigen::Matrix<double, 9, 1> R = rotation_rows(T.rotation);
  std::string rows;
  for (int i = 0; i < 3; ++i)
    rows += "[" + joined(R.segment<3>(3 * i), ", ") + ", " + exact(T.translation[i]) + "], ";
  return "{\n    \"translation_m\": " + named({"x", "y", "z"}, T.translation.data()) +
         ",\n    \"rotation_quaternion\": " + named({"w", "x", "y", "z"}, q.data()) +
         ",\n    \"rotation_rad\": " + named({"roll", "pitch", "yaw"}, angles.data()) +
         ",\n    \"matrix\": [" + rows + "[0, 0, 0, 1]]\n  }";
}

}  // namespace

std::string json_text(const ExtrinsicWords& words) {
  std::string text =
      "{\n  \"schema\": 1,\n  \"parent\": \"" + words.a + "\",\n  \"child\": \"" + words.b + "\",\n";
  text += "  \"direction\": \"" + words.direction + "\",\n";
  text += "  \"T_parent_child\": " + pose_json(words.T) + ",\n";
  text += "  \"T_child_parent\": " + pose_json(inverse(words.T)) + ",\n";
  if (words.extrinsic.stddev)
    text += "  \"stddev\": " +
            named({"x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad"}, words.extrinsic.stddev->data()) +
            ",\n";
  text += "  \"verdict\": " +
          (words.extrinsic.verdict.empty() ? std::string("null") : in_quotes(words.extrinsic.verdict)) +
          ",\n";
  text += "  \"reason\": " + in_quotes(words.extrinsic.reason) + ",\n";
  text += "  \"not_observable\": " + list_in_quotes(not_observable(words.extrinsic)) + ",\n";
  text += "  \"not_observable_frame\": \"" + frame_name(backing_frame(words.extrinsic)) + "\",\n";
  text += "  \"from_nominal\": " + list_in_quotes(directions_with(words.extrinsic, Backing::nominal)) + ",\n";
  text += std::string("  \"usable\": ") + (words.extrinsic.usable ? "true" : "false") + ",\n";
  text += std::string("  \"certified\": ") + (words.extrinsic.certified ? "true" : "false") + ",\n";
  if (words.extrinsic.scale) {
    const NamedScale& scale = *words.extrinsic.scale;
    text += "  \"scale\": {\"sensor\": \"" + frame_name(scale.sensor) +
            "\", \"value\": " + exact(scale.value) +
            ", \"stddev\": " + (std::isfinite(scale.stddev) ? exact(scale.stddev) : "null") +
            ", \"certified\": " + (scale.certified ? "true" : "false") +
            ", \"metres\": " + (scale.metres ? "true" : "false") +
            (scale.changes ? ", \"changes\": true" : "") + "},\n";
  }
  return text + "  \"pairs\": " + std::to_string(words.extrinsic.pairs) + "\n}\n";
}

}  // namespace egocal::detail
