// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "offline/drives/clocks_of_drives.hpp"
#include "offline/rig/settings.hpp"

namespace egocal::tools {

/// What was added to the stamps of a sensor [s], and after what time its motion repeats, so that another
/// offset fits as well [s]; 0: none does.
struct ClockOfSensor {
  double offset = 0, period = 0;
  std::vector<ClockOfDrive> drives;  ///< where drives have clocks of their own; `offset` is that of the first
  std::size_t group = 0;  ///< sensors of one group are on one clock: between two no offset was found
};

/// All sensors on the clock of the first one: by the offsets of the rig file's pairs, and by those that are
/// found from the streams where the file or the request asks for them. A sensor whose offset cannot be found,
/// as one that is frozen, begins a group of its own. Throws Error where those of the file contradict each
/// other.
std::vector<ClockOfSensor> synchronise(const RigRequest& request, const RigSettings& settings,
                                       const Drives& drives, std::vector<Trajectory>& trajectories);

}  // namespace egocal::tools
