// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "egocal/io/recording.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::tools {

/// Any recording that egocal reads: what the library knows, and LCM logs.
std::unique_ptr<Recording> open_any_recording(const std::string& file, const ReadOptions& options = {});

/// The trajectory FILE, FILE:TOPIC or LOG:CHANNEL. Throws Error as read_trajectory_file does.
TrajectoryReading read_any_trajectory(const std::string& name, const ReadOptions& options = {});

/// The same; the reader's notes go to the warnings, with the name. has_scale: whether lengths are meant to be
/// metres; nullptr: not asked.
Trajectory read_noting(const std::string& name, const ReadOptions& options,
                       std::vector<std::string>& warnings, bool* has_scale = nullptr);

}  // namespace egocal::tools
