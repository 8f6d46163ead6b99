// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string lio_sam_text(const ExtrinsicWords& words) {
  const std::string R = joined(rotation_rows(words.T.rotation), ", ");
  return "# For params.yaml of LIO-SAM. lidar (parent): " + words.a + ", imu (child): " + words.b +
         ".\n# extrinsicRot turns vectors of the imu into the lidar's axes, extrinsicTrans is the imu's "
         "place in the "
         "lidar's frame:\n# " +
         words.direction + ", " + words.lengths + "; quaternion w x y z: [" +
         joined(wxyz(words.T.rotation), ", ") + "].\n# " + words.verdict +
         "\n# extrinsicRPY is the same rotation where the imu's orientation refers to its own axes.\n" +
         "extrinsicTrans: [" + joined(words.T.translation, ", ") + "]\nextrinsicRot: [" + R +
         "]\nextrinsicRPY: [" + R + "]\n";
}

}  // namespace egocal::detail
