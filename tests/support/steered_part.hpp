// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// b of a simulated drive on a part of the vehicle that turns about the vertical by `seconds` times the
/// turning rate, as a bogie or a head that looks into the curve does.
inline Trajectory on_a_steered_part(const Trajectory& poses, double seconds) {
  const DualQuaternion mounting = to_dual_quaternion(T_vehicle_b);
  Trajectory result = poses;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const DualQuaternion before = poses[i - 1].pose * conjugate(mounting),
                         after = poses[i + 1].pose * conjugate(mounting);
    const double time = 1e-6 * static_cast<double>(poses[i + 1].time_us - poses[i - 1].time_us);
    const double rate = rotation_log(to_pose(conjugate(before) * after).rotation).z() / time;
    const DualQuaternion aside =
        to_dual_quaternion(Pose{rotation_exp({0, 0, seconds * rate}), Eigen::Vector3d::Zero()});
    result[i].pose = canonical_sign(normalized(poses[i].pose * conjugate(mounting) * aside * mounting));
  }
  return result;
}

}  // namespace egocal::testing
