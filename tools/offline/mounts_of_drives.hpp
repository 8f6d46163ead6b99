// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives that were appended have a boundary that is known: a mount that was moved between them is no creep.
#pragma once

#include "egocal/calibrate.hpp"
#include "offline/append.hpp"

namespace egocal::tools {

struct MountsOfDrivesOptions {
  /// A difference shows in the components that exceed this many standard deviations, both drives' together.
  /// As ShownChange. Study: docs/moves.md, "Between drives".
  double sigmas = 3;
};

/// Where the drives together are doubtful or contradictory, two consecutive ones that are not so by
/// themselves are compared. A mount that differs between them is a finding without a time, "The mounts of
/// drive 1 (a.tum) and drive 2 (a2.tum) differ by 5.00 deg.", in place of what only all drives together show:
/// a creep, or wrong axes. Where some drive is not usable by itself, all former findings stay beside it: they
/// may be of that drive. Where the lengths are not metres, only rotations are compared. a, b, options: as
/// they were calibrated; calibration: the answer to all of them.
void name_mounts_of_drives(const Drives& drives, const Trajectory& a, const Trajectory& b,
                           const CalibrationOptions& options, Calibration& calibration,
                           const MountsOfDrivesOptions& mounts = {});

}  // namespace egocal::tools
