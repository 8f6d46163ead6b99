// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "offline/rig/calibration.hpp"
#include "offline/rig/joint.hpp"

namespace egocal::tools {

/// Sets findings and the sensor to blame from what the pairs found, the moves of the mounts, the loops and
/// the noise. motions: of all sensors; a move that a pair's diagnosis shows is looked for in the longer and
/// in the shorter ones, to name the sensor.
void find_in_rig(const CommonMotions& motions, const std::vector<Trajectory>& trajectories,
                 const RigRequest& request, const RigSettings& settings, RigReport& report);

}  // namespace egocal::tools
