// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// Reads a trajectory, its format told by the content: TUM (`time tx ty tz qx qy qz qw` [s]), EuRoC csv
/// (`time[ns], x, y, z, qw, qx, qy, qz, ...`), or KITTI (12 numbers, 3 x 4 row by row) with a file of times
/// [s], one a line. Times are rounded to microseconds from the decimal text, without passing through a
/// double. Lines that are empty or begin with # are skipped. Throws Error naming file, line and field:
/// missing or empty file, wrong number of fields, not a number, NaN, zero quaternion, time not increasing,
/// different numbers of poses and times.
Trajectory read_trajectory(const std::string& file, const std::string& times_file = "");

/// Writes TUM. The file appears whole or not at all.
void write_tum(const std::string& file, const Trajectory& trajectory);

}  // namespace egocal
