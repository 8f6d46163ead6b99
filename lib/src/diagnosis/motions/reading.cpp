// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/reading.hpp"

#include <cmath>

#include "egocal/error.hpp"

namespace egocal {

namespace {

// Number by number: a diagnosis reads some hundred thousand poses, and temporary vectors cost more than the
// arithmetic.

/// 0.5 t r. The zero scalar of t counts: it turns negative zeros into positive ones.
QuaternionVector dual_part(const QuaternionVector& r, const Eigen::Vector3d& t) {
  return {0.5 * (0.0 * r[0] - t[0] * r[1] - t[1] * r[2] - t[2] * r[3]),
          0.5 * (0.0 * r[1] + t[0] * r[0] + t[1] * r[3] - t[2] * r[2]),
          0.5 * (0.0 * r[2] - t[0] * r[3] + t[1] * r[0] + t[2] * r[1]),
          0.5 * (0.0 * r[3] + t[0] * r[2] - t[1] * r[1] + t[2] * r[0])};
}

}  // namespace

Eigen::Vector3d detail::position_of(const DualQuaternion& pose) {
  const QuaternionVector &p = pose.dual, &r = pose.real;
  const double w = r[0], x = -r[1], y = -r[2], z = -r[3];
  return {2 * (p[0] * x + p[1] * w + p[2] * z - p[3] * y), 2 * (p[0] * y - p[1] * z + p[2] * w + p[3] * x),
          2 * (p[0] * z + p[1] * y - p[2] * x + p[3] * w)};
}

bool detail::as_given(const PoseReading& reading) {
  return reading.quaternion_order == QuaternionOrder::as_read && !reading.invert && !reading.conjugate &&
         reading.scale == 1 && reading.axes == Eigen::Matrix3d::Identity();
}

DualQuaternion detail::reread(const DualQuaternion& given, const PoseReading& reading) {
  if (as_given(reading)) return given;
  Eigen::Vector3d t = reading.scale * (reading.axes * detail::position_of(given));
  QuaternionVector r = given.real;
  // read as x y z w and stored here as w x y z: the columns were (r1, r2, r3, r0)
  if (reading.quaternion_order == QuaternionOrder::wxyz) r = {r[1], r[2], r[3], r[0]};
  // read as w x y z: the columns were (r0, r1, r2, r3), the scalar is the last
  if (reading.quaternion_order == QuaternionOrder::xyzw) r = {r[3], r[0], r[1], r[2]};
  if (reading.conjugate) r = quaternion_conjugate(r);
  const DualQuaternion pose{r, dual_part(r, t)};
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
