// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string kalibr_text(const ExtrinsicWords& words) {
  const Pose inverted = inverse(words.T);
  return "# Kalibr's T_cam_imu takes points of the imu frame into the camera frame: p_" + words.b +
         " = T_cam_imu * p_" + words.a + ",\n# so it is the inverse of the pose of " + words.b + " in " +
         words.a + ". imu (parent): " + words.a + ", cam0 (child): " + words.b + ".\n# " + words.lengths +
         "; the rotation as quaternion w x y z: [" + joined(wxyz(inverted.rotation), ", ") + "]\n# " +
         words.verdict_of_inverse + "\ncam0:\n  T_cam_imu:\n" + matrix_rows(inverted, "  ");
}

}  // namespace egocal::detail
