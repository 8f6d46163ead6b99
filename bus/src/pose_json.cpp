// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/pose_json.hpp"

#include <nlohmann/json.hpp>

namespace egocal::bus {

void put_pose(nlohmann::ordered_json& object, const Pose& T) {
  object["translation"] = {T.translation.x(), T.translation.y(), T.translation.z()};
  object["rotation_wxyz"] = {T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()};
}

nlohmann::ordered_json pose_json(const Pose& T) {
  nlohmann::ordered_json object;
  put_pose(object, T);
  return object;
}

}  // namespace egocal::bus
