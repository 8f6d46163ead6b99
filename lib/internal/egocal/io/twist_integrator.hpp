// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal {

/// Velocities of a sensor in its own frame.
struct Twist {
  std::int64_t time_us = 0;
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// Sums velocities up to poses in the frame of the first one: between two samples the sensor moves along the
/// screw of their mean. For radars and wheels, which give no poses. One object a stream, one thread at a
/// time.
class TwistIntegrator {
 public:
  /// The pose at the time of the sample; empty where it is not later than the one before, not finite, or so
  /// fast that its pose is none.
  std::optional<DualQuaternion> add(const Twist& twist);

 private:
  std::optional<Twist> last_;
  DualQuaternion pose_;
};

}  // namespace egocal
