// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// The poses of a stream as its file has them: with times that may repeat or step back.
struct PosesOfFile {
  std::vector<StampedPose> poses;
  /// Of each pose: its row of data, from 0. Comments, headers and empty lines are no rows; those that hold no
  /// pose that can be used (NaN, a zero quaternion) are. Of a recording: the number of the message.
  std::vector<std::size_t> rows;
  std::size_t count = 0;  ///< rows of the file
};

/// All poses of a trajectory, each in a row of its own.
PosesOfFile as_rows(const Trajectory& trajectory);

}  // namespace egocal
