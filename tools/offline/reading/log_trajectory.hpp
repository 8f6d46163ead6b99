// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/pairing/stream.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// One channel of an LCM log.
struct LogTrajectory {
  Trajectory poses;  ///< times strictly ascending
  /// One line: what the log holds of this channel and the poses do not; empty: nothing.
  std::string not_used;
  std::string times;   ///< one line: which times were taken where the messages have none; empty: their own
  std::string damage;  ///< one line: of the log as a whole, see damage_in_words(); empty: none
};

/// The poses of one channel of an LCM log (egocal.odometry_t or bot_core.pose_t, recognised by their
/// fingerprint), of its first session: up to where time goes back by more than 10 s. They pass the Stream
/// that live odometry passes, with its look-ahead: a damaged time stamp or number costs its own pose. Throws
/// Error naming the file and, where the channel is not there, channels that are.
LogTrajectory read_log_trajectory(const std::string& file, const std::string& channel);

}  // namespace egocal::tools
