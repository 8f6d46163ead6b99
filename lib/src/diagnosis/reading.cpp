// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/reading.hpp"

#include <cmath>

#include "egocal/error.hpp"

namespace egocal {

namespace {

/// Vector part of 2 dual conj(real): the position [m].
Eigen::Vector3d position(const DualQuaternion& pose) {
  return 2 * quaternion_product(pose.dual, quaternion_conjugate(pose.real)).tail<3>();
}

DualQuaternion from_parts(const Eigen::Vector4d& real, const Eigen::Vector3d& position) {
  Eigen::Vector4d t;
  t << 0, position;
  return {real, 0.5 * quaternion_product(t, real)};
}

bool as_given(const detail::PoseReading& reading) {
  return reading.quaternion_order == QuaternionOrder::as_read && !reading.invert && !reading.conjugate &&
         reading.scale == 1 && reading.axes == Eigen::Matrix3d::Identity();
}

}  // namespace

DualQuaternion detail::reread(const DualQuaternion& given, const PoseReading& reading) {
  if (as_given(reading)) return given;
  Eigen::Vector3d t = reading.scale * (reading.axes * position(given));
  Eigen::Vector4d r = given.real;
  // read as x y z w and stored here as w x y z: the columns were (r1, r2, r3, r0)
  if (reading.quaternion_order == QuaternionOrder::wxyz) r = {r[1], r[2], r[3], r[0]};
  // read as w x y z: the columns were (r0, r1, r2, r3), the scalar is the last
  if (reading.quaternion_order == QuaternionOrder::xyzw) r = {r[3], r[0], r[1], r[2]};
  if (reading.conjugate) r = quaternion_conjugate(r);
  const DualQuaternion pose = from_parts(r, t);
  return reading.invert ? conjugate(pose) : pose;
}

Trajectory reread(const Trajectory& trajectory, const Reading& reading) {
  if (!(reading.scale > 0) || !std::isfinite(reading.scale))
    throw Error("scale: expected a factor greater than zero");
  detail::PoseReading full;
  static_cast<Reading&>(full) = reading;
  Trajectory result = trajectory;
  for (StampedPose& stamped : result) stamped.pose = canonical_sign(detail::reread(stamped.pose, full));
  return result;
}

}  // namespace egocal
