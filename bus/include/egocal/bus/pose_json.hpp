// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A pose as machine-readable output, the same in every tool and in findings.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "egocal/geometry/pose.hpp"

namespace egocal::bus {

/// Sets the members translation, x y z in the unit of the pose (metres unless a scale is open), and
/// rotation_wxyz of an object.
void put_pose(nlohmann::ordered_json& object, const Pose& T);
/// An object with these two members.
nlohmann::ordered_json pose_json(const Pose& T);

}  // namespace egocal::bus
