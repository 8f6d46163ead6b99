// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives that were appended have a boundary that is known: a mount that was moved between them is no creep,
// and what is wrong with one of them is not wrong with all.
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/moves/find_moves.hpp"
#include "offline/drives/append.hpp"

namespace egocal::tools {

struct MountsOfDrivesOptions {
  /// A difference shows in the components that exceed this many standard deviations, both drives' together.
  /// As ShownChange. Study: docs/moves.md, "Between drives".
  double sigmas = 3;
};

/// Two drives, the second one later, between which a mount was moved.
struct MountsDiffer {
  std::size_t first = 0, second = 0;
  ShownChange shown;
  Finding finding;  ///< that says so
};

/// Each drive is calibrated by itself, and each that is usable is compared with the usable one before it.
/// Where the drives together are usable, one that is not gives them its verdict and reason
/// (own_fault_of_drive()), and a mount that differs by more than is tolerated makes them contradictory. Where
/// the drives together are doubtful or contradictory, a mount that differs is a finding without a time, "The
/// mounts of drive 1 (a.tum) and drive 2 (a2.tum) differ by 5.00 deg.", and is handed back. A drive that is
/// not usable beside others that are is named with its own fault (fault_of_drive()), before them. Both take
/// the place of what only all drives together show, a creep or wrong axes; where some drive is not usable and
/// has no such fault, all former findings stay beside them: they may be of that drive. Where the lengths are
/// not metres, only rotations are compared. sensor_a, sensor_b: of the drives; a, b, options: as they were
/// calibrated; calibration: the answer to all of them.
std::vector<MountsDiffer> name_what_drives_differ_in(const Drives& drives, std::size_t sensor_a,
                                                     std::size_t sensor_b, const Trajectory& a,
                                                     const Trajectory& b, const CalibrationOptions& options,
                                                     Calibration& calibration,
                                                     const MountsOfDrivesOptions& mounts = {});

}  // namespace egocal::tools
