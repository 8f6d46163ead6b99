// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/io/recording.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/pairing/poses_of_file.hpp"

namespace egocal {

/// read_trajectory_of() that also gives the poses as the file has them. What was sorted and left away
/// (repairs_in_words()) is not among the notes. A chain of transforms has no rows: those of its poses.
TrajectoryReading read_trajectory_of(Recording& recording, const std::string& topic, PosesOfFile& as_given);

/// "1 pose was out of order: sorted by time", and the like.
std::vector<std::string> repairs_in_words(const TrajectoryReading& reading);

}  // namespace egocal
