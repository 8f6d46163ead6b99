// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Trajectories of any format as a log that can be played.
#pragma once

#include <string>
#include <vector>

#include "egocal/io/trajectory_file.hpp"

namespace egocal::tools {

struct SensorFile {
  std::string sensor, file;  ///< file: FILE or FILE:TOPIC
};

/// Writes the poses of these files in the order of time on the channels of a rig's sensors. Times that begin
/// near zero are no dates: a number of seconds is added to all of them. Returns warnings. Throws Error where
/// a file cannot be read, a sensor is unknown, or the log cannot be written.
std::vector<std::string> create_log(const std::string& rig_file, const std::vector<SensorFile>& from,
                                    const ReadOptions& reading, const std::string& out);

}  // namespace egocal::tools
