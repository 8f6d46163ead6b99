// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/rig.hpp"

namespace egocal::bus {

/// A message of an odometry channel.
struct ReceivedOdometry {
  bool decoded = false;  ///< it is of the type that the rig states
  Checked<StampedPose> pose;
  std::int64_t seq = -1;  ///< -1: not counted
};

/// Time of the measurement in a message of either odometry type [us], also in a damaged one: both types begin
/// with the fingerprint and then utime, 8 bytes each, big endian. Player and pairing identify a message by
/// it. 0: too short.
std::int64_t utime_in(Bytes message);

/// Decodes a message, with the scale of the sensor applied.
ReceivedOdometry decode_odometry(const Sensor& sensor, Bytes bytes);

}  // namespace egocal::bus
