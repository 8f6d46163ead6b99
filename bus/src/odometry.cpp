// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/odometry.hpp"

namespace egocal::bus {

ReceivedOdometry decode_odometry(OdometryType type, Bytes bytes) {
  ReceivedOdometry result;
  if (type == OdometryType::pose) {
    bot_core::pose_t message{};
    result.decoded = decode(bytes, message);
    if (result.decoded) result.pose = to_stamped_pose(message);
  } else {
    odometry_t message{};
    result.decoded = decode(bytes, message);
    if (result.decoded) result.pose = to_stamped_pose(message);
    result.seq = message.seq;
  }
  return result;
}

}  // namespace egocal::bus
