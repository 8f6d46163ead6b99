// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/io/twist_integrator.hpp"

namespace egocal::tools {

/// A pose message of an LCM log.
struct LcmPose {
  bus::Checked<StampedPose> pose;
  std::int64_t seq = -1;         ///< -1: its type has none
  std::string type;              ///< "egocal.odometry_t"; empty: no pose message
  std::optional<Twist> twist{};  ///< of a message with velocities, whose pose is not known by itself
  bool unstamped = false;        ///< its sender filled in no time: that of recording is taken
};

/// Decodes any of the types that hold a pose, recognised by their fingerprints. A message of another type, or
/// with values that are no pose, is refused. recorded_us: for a message whose time is zero; 0: it is refused.
LcmPose decode_lcm_pose(bus::Bytes bytes, std::int64_t recorded_us = 0);

/// Which time counts in one channel: that of recording only where no message has another.
class ChannelTimes {
 public:
  /// The message, refused where it has no time and others do.
  LcmPose checked(LcmPose message);
  /// "12 messages have no time stamp: the time of recording was taken"; empty: none.
  std::string note() const;

 private:
  std::uint64_t stamped_ = 0, unstamped_ = 0;
};

/// The message with its pose, where it holds velocities: integrated since the stream's first one.
LcmPose with_integrated_pose(LcmPose message, TwistIntegrator& stream);

}  // namespace egocal::tools
