// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"

namespace egocal::tools {

/// A pose message of an LCM log.
struct LcmPose {
  bus::Checked<StampedPose> pose;
  std::int64_t seq = -1;  ///< -1: its type has none
  std::string type;       ///< "egocal.odometry_t"; empty: no pose message
};

/// Any of the types that hold a pose, recognised by their fingerprints; a message of another type, or with
/// values that are no pose, is refused.
LcmPose decode_lcm_pose(bus::Bytes bytes);

}  // namespace egocal::tools
