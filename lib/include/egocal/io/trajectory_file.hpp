// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "egocal/io/recording.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// A trajectory with what had to be assumed, repaired or dropped to get it.
struct TrajectoryReading {
  Trajectory trajectory;  ///< strictly increasing times
  std::string format;     ///< "TUM", "MCAP", ...
  std::string stream;     ///< topic or channel that was read
  ReadLosses losses;
  std::uint64_t out_of_order = 0;  ///< poses that came after a later one: sorted in
  std::uint64_t duplicates = 0;    ///< poses with the time of another one: the first is kept
  std::vector<std::string> notes;  ///< assumptions and repairs in words, one sentence each
};

/// Reads the trajectory `name`: FILE, or FILE:TOPIC where the file holds several. Formats are recognised by
/// content: TUM (`time tx ty tz qx qy qz qw`), KITTI (12 numbers, 3 x 4 row by row; with a file of times, or
/// at options.rate), EuRoC csv (`time[ns], x, y, z, qw, qx, qy, qz, ...`), tables with named columns, MCAP,
/// ROS 1 bags, rosbag2 databases; FILE:/tf:PARENT/CHILD is a chain of transforms, resolved by time. Times are
/// rounded once to microseconds. Throws Error naming file, line or stream and what was expected; without a
/// topic where several streams hold poses it names them all.
TrajectoryReading read_trajectory_file(const std::string& name, const ReadOptions& options = {});

/// The same of a recording that is open already.
TrajectoryReading read_trajectory_of(Recording& recording, const std::string& topic);

/// The poses alone. times_file: for KITTI.
Trajectory read_trajectory(const std::string& name, const std::string& times_file = "");

/// Sorts by time and keeps the first of equal times; counts both.
void put_in_order(TrajectoryReading& reading);

/// Writes TUM. The file appears whole or not at all.
void write_tum(const std::string& file, const Trajectory& trajectory);

}  // namespace egocal
