// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// The poses of one channel of an LCM log (egocal.odometry_t or bot_core.pose_t, told apart by their
/// fingerprint), of its first session: up to where time runs backwards. Throws Error naming the file and,
/// where the channel is not there, the channels that are.
Trajectory read_log_trajectory(const std::string& file, const std::string& channel);

}  // namespace egocal::tools
