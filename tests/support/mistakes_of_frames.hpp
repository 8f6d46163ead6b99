// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses in other frames, axes and conventions than they are read in.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

inline Trajectory changed(Trajectory trajectory, const std::function<Pose(const Pose&)>& change) {
  for (StampedPose& stamped : trajectory)
    stamped.pose = canonical_sign(to_dual_quaternion(change(to_pose(stamped.pose))));
  return trajectory;
}

inline Trajectory inverted(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) { return inverse(pose); });
}

/// Positions moved by a lever arm of the body [m] with the rotations from the world to the body.
inline Trajectory with_turned_lever_arm(const Trajectory& trajectory, const Eigen::Vector3d& arm) {
  return changed(trajectory, [&arm](const Pose& pose) {
    return Pose{pose.rotation, pose.translation + pose.rotation.conjugate() * arm};
  });
}

/// Columns w x y z in a file whose readers expect x y z w, and the other way round.
inline Trajectory scalar_first(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return Pose{Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()), pose.translation};
  });
}
inline Trajectory scalar_last(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return Pose{Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
  });
}

/// The position's columns alone.
inline Trajectory with_position_columns(const Trajectory& trajectory, const Eigen::Matrix3d& P) {
  return changed(trajectory, [&](const Pose& pose) { return Pose{pose.rotation, P * pose.translation}; });
}

inline Trajectory with_inverse_rotations(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    return Pose{pose.rotation.conjugate(), pose.translation};
  });
}

/// From a part of the drive on, the sensor looks and sits differently: T_old_new.
inline Trajectory knocked(Trajectory trajectory, double part, const Pose& T_old_new) {
  const auto first = static_cast<std::size_t>(part * static_cast<double>(trajectory.size()));
  const DualQuaternion change = to_dual_quaternion(T_old_new);
  for (std::size_t i = first; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(trajectory[i].pose * change));
  return trajectory;
}

/// Every pose with its position in the frame of the sensor: the position of the inverse pose.
inline Trajectory with_inverse_positions(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) { return Pose{pose.rotation, inverse(pose).translation}; });
}

/// The trajectory in a left-handed world and body: y is on the other side.
inline Trajectory mirrored(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    const Eigen::Vector3d& t = pose.translation;
    return Pose{Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
  });
}

/// Roll, pitch and yaw applied in the opposite order.
inline Trajectory with_angles_in_another_order(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    const double roll = std::atan2(R(2, 1), R(2, 2)), yaw = std::atan2(R(1, 0), R(0, 0));
    const double pitch = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
    const Eigen::Quaterniond q =
        rotation_exp({roll, 0, 0}) * rotation_exp({0, pitch, 0}) * rotation_exp({0, 0, yaw});
    return Pose{q.normalized(), pose.translation};
  });
}

/// Roll, pitch and yaw [rad] as a program changed them: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Trajectory with_angles(const Trajectory& trajectory,
                              const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& change) {
  return changed(trajectory, [&](const Pose& pose) {
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    const Eigen::Vector3d x =
        change({std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
                std::atan2(R(1, 0), R(0, 0))});
    const Eigen::Quaterniond q =
        rotation_exp({0, 0, x[2]}) * rotation_exp({0, x[1], 0}) * rotation_exp({x[0], 0, 0});
    return Pose{q.normalized(), pose.translation};
  });
}

/// Poses of two frames of the same body in one stream: those that `of_other` picks are of the frame that is
/// at T in the right one.
inline Trajectory with_another_frame(Trajectory trajectory, const Pose& T,
                                     const std::function<bool(std::size_t)>& of_other) {
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (of_other(i))
      trajectory[i].pose = canonical_sign(normalized(trajectory[i].pose * to_dual_quaternion(T)));
  return trajectory;
}

/// Every n-th pose, of two publishers at fixed rates.
inline std::function<bool(std::size_t)> every(std::size_t n) {
  return [n](std::size_t i) { return i % n == 0; };
}

/// Each pose with this probability, of two publishers that know nothing of each other.
inline std::function<bool(std::size_t)> at_random(double part, std::uint64_t seed) {
  return [part, random = Random(seed)](std::size_t) mutable { return random.uniform() < part; };
}

/// The motions as another frame of the same body has them.
inline Trajectory seen_from(const Trajectory& trajectory, const DualQuaternion& T) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) pose.pose = canonical_sign(normalized(T * pose.pose * conjugate(T)));
  return result;
}

/// After each `every` rows, one of a second odometry on the same vehicle: from its own mounting and origin.
inline Trajectory with_another_sender(const Trajectory& trajectory, std::size_t every) {
  const DualQuaternion origin = to_dual_quaternion({rotation_exp({0, 0, 2.1}), {6, -4, 0}}),
                       mounting = to_dual_quaternion({rotation_exp({0.3, -0.2, 1}), {0.4, 0.3, -0.2}});
  Trajectory result;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    const StampedPose& here = trajectory[i];
    result.push_back(here);
    if (i % every != 0) continue;
    const std::int64_t later = 2 * (trajectory[i + 1].time_us - here.time_us) / 5;
    result.push_back({here.time_us + later, canonical_sign(normalized(origin * here.pose * mounting))});
  }
  return result;
}

}  // namespace egocal::testing
