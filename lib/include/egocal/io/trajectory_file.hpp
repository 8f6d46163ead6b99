// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// What a file itself does not say. The defaults need no setting for most files.
struct ReadOptions {
  std::string times_file;  ///< KITTI: one time a line [s]
  /// Names of the columns of a table, in order and separated by commas, where it has no header or one that is
  /// not understood: t x y z qw qx qy qz, or roll pitch yaw, yaw, latitude longitude height; `-` skips one.
  /// A unit may follow in brackets: t[ns], yaw[deg].
  std::string columns;
  double rate = 0;  ///< poses without times: their rate [Hz]; 0: 10 is assumed and reported in the notes
  /// Nothing is repaired or passed over: an Error where poses are out of order, have the time of another one,
  /// or are lost (damage, rows and messages that hold no pose), and where the recording contradicts itself.
  bool strict = false;
};

/// What a recording has lost: nothing is dropped without being counted here.
struct ReadLosses {
  std::uint64_t regions = 0;  ///< damaged places that were skipped
  std::uint64_t bytes = 0;    ///< in them, as far as they could be counted
  bool truncated = false;     ///< the file ends in the middle of a record: a recorder that was killed
  bool checksum = false;      ///< the checksum of the whole data differs, and nothing shows where
  std::uint64_t refused = 0;  ///< messages or rows that could be read but hold no pose: NaN, zero quaternion
  std::string first_refused;  ///< why the first of them was refused, and where
  std::uint64_t parts = 0;    ///< whole files of a bag of several that are missing or cannot be read
  std::string first_part;     ///< which the first of them is, and why

  bool any() const { return regions > 0 || truncated || checksum || refused > 0 || parts > 0; }
};

/// "2 damaged regions (381 bytes) skipped, the end is cut off"; empty where nothing was lost.
std::string losses_in_words(const ReadLosses& losses);

/// A trajectory with what had to be assumed, repaired or dropped to get it.
struct TrajectoryReading {
  Trajectory trajectory;  ///< strictly increasing times
  std::string format;     ///< "TUM", "MCAP", ...
  std::string stream;     ///< topic or channel that was read
  ReadLosses losses;
  std::uint64_t out_of_order = 0;  ///< poses that came after a later one: sorted in
  std::uint64_t duplicates = 0;    ///< poses with the time of another one: the first is kept
  std::string first_repair;        ///< the first of either, in words; empty: none
  std::vector<std::string> notes;  ///< assumptions and repairs in words, one sentence each
  /// What the recording says in two ways of which one was taken; they are among the notes.
  std::vector<std::string> contradictions;
  bool has_scale = true;  ///< false: the format has lengths of no unit (COLMAP)
};

/// Reads the trajectory `name`: FILE, or FILE:TOPIC where the file holds several. Formats are recognised by
/// content: TUM (`time tx ty tz qx qy qz qw`), KITTI (12 numbers, 3 x 4 row by row; with a file of times, or
/// at options.rate), EuRoC csv (`time[ns], x, y, z, qw, qx, qy, qz, ...`), tables with named columns, MCAP,
/// ROS 1 bags, rosbag2 databases; FILE:/tf:PARENT/CHILD is a chain of transforms, resolved by time. Times are
/// rounded once to microseconds. Throws Error naming file, line or stream and what was expected; without a
/// topic where several streams hold poses it names them all.
TrajectoryReading read_trajectory_file(const std::string& name, const ReadOptions& options = {});

/// The poses alone. times_file: for KITTI. Throws Error as read_trajectory_file() does; what was lost or
/// assumed while reading is not reported.
Trajectory read_trajectory(const std::string& name, const std::string& times_file = "");

/// Writes TUM. The file appears whole or not at all. Throws Error naming it where it cannot be written.
void write_tum(const std::string& file, const Trajectory& trajectory);

}  // namespace egocal
