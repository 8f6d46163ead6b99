// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/bus/log_file.hpp"

namespace egocal::tools {

struct McapOfLog {
  std::uint64_t poses = 0, transforms = 0;  ///< written
  std::uint64_t refused = 0;                ///< messages whose values cannot be
  bus::LogDamage damage;
};

/// Writes poses of every channel as topics and transforms, calibrations as transforms: for ROS 2 and
/// Foxglove. All have the times of the drive, which may have been played and recorded on another day. Throws
/// Error where the log holds neither.
McapOfLog log_as_mcap(const std::string& file, const std::string& out);

}  // namespace egocal::tools
