// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/directions.hpp"
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string autoware_text(const ExtrinsicWords& words) {
  const Eigen::Vector3d& t = words.T.translation;
  const Eigen::Vector3d angles = roll_pitch_yaw(words.T.rotation);
  std::string text = "# sensors_calibration.yaml: " + words.direction + "; " + words.lengths +
                     ", radians, R = Rz(yaw) Ry(pitch) Rx(roll)\n# " + "quaternion w x y z: [" +
                     joined(wxyz(words.T.rotation), ", ") + "]\n# " + words.verdict + "\n";
  text += yaml_word(words.a) + ":\n  " + yaml_word(words.b) + ":\n";
  for (int i = 0; i < 6; ++i)
    text += std::string("    ") + direction_names[i] + ": " + exact(i < 3 ? t[i] : angles[i - 3]) + "\n";
  return text;
}

}  // namespace egocal::detail
