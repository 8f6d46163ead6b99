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

/// With the scale of the sensor applied.
ReceivedOdometry decode_odometry(const Sensor& sensor, Bytes bytes);

}  // namespace egocal::bus
