// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// Appends another drive of the same sensors, one trajectory each, an hour after the end of what is there: no
/// motion spans such a gap, so each drive may have an odometry frame of its own.
void append_drive(const std::vector<Trajectory*>& sensors, std::vector<Trajectory> drive);

}  // namespace egocal::tools
