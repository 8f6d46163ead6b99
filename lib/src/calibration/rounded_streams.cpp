// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/rounded_streams.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/reading.hpp"
#include "diagnosis/streams/written_digits.hpp"
#include "egocal/geometry/pose.hpp"
#include "pairing/congruence_floors.hpp"

namespace egocal::detail {

namespace {

/// Standard deviations of one pose: of its rotation about an axis [rad] and of a coordinate [m].
struct OfPose {
  double rotation = 0, coordinate = 0;
};

/// A number that is rounded to a step errs by its twelfth part, squared. A rotation vector is twice the
/// vector of its quaternion, and half the difference of two elements of its matrix.
OfPose rounding_of_pose(const Trajectory& trajectory) {
  const double of_step = 1 / std::sqrt(12.0), of_matrix = std::sqrt(0.5) * of_step,
               of_quaternion = 2 * of_step;
  const Written digits = written(trajectory);
  double place = 0, vector = 0;  // the scalar part is near 1, where it says little of the rotation
  for (const StampedPose& stamped : trajectory) {
    place = std::max(place, position_of(stamped.pose).cwiseAbs().maxCoeff());
    vector = std::max(vector, stamped.pose.real.tail<3>().cwiseAbs().maxCoeff());
  }
  return {digits.rotation.known() ? of_quaternion * digits.rotation.step(vector)
                                  : of_matrix * digits_of_matrices(trajectory).step(1),
          of_step * digits.position.step(place)};
}

}  // namespace

PairingOptions with_rounding(PairingOptions options, const Trajectory& a, const Trajectory& b) {
  const OfPose of_a = rounding_of_pose(a), of_b = rounding_of_pose(b);
  const double poses = 2;  // of a motion
  const double angle = std::sqrt(poses) * std::hypot(of_a.rotation, of_b.rotation),
               length = std::sqrt(poses) * std::hypot(of_a.coordinate, of_b.coordinate);
  CongruenceOptions& congruence = options.screening.congruence;
  congruence.angle_floor = std::max(congruence.angle_floor, std::min(angle, angle_floors.most));
  congruence.length_floor = std::max(congruence.length_floor, std::min(length, length_floors.most));
  return options;
}

}  // namespace egocal::detail
