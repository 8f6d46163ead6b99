// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses of other drives, and poses that are filtered, repeated or in another order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// Every pose the mean of its neighbours: a filter without lag.
inline Trajectory smoothed(const Trajectory& trajectory, std::size_t reach) {
  Trajectory result = trajectory;
  for (std::size_t i = reach; i + reach < trajectory.size(); ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
    for (std::size_t k = i - reach; k <= i + reach; ++k) {
      const Pose pose = to_pose(trajectory[k].pose);
      const Eigen::Vector4d q = trajectory[k].pose.real;
      position += pose.translation;
      rotation += q.dot(trajectory[i].pose.real) < 0 ? Eigen::Vector4d(-q) : q;
    }
    rotation.normalize();
    const Pose mean{Rotation(rotation[0], rotation[1], rotation[2], rotation[3]),
                    position / static_cast<double>(2 * reach + 1)};
    result[i].pose = canonical_sign(to_dual_quaternion(mean));
  }
  return result;
}

/// The last pose before [begin, end) of the drive again and again.
inline Trajectory frozen(Trajectory trajectory, double begin, double end) {
  const auto n = static_cast<double>(trajectory.size());
  const auto first = static_cast<std::size_t>(begin * n), last = static_cast<std::size_t>(end * n);
  for (std::size_t i = first; i < last; ++i) trajectory[i].pose = trajectory[first].pose;
  return trajectory;
}

/// The poses in the opposite order.
inline Trajectory backwards(Trajectory trajectory) {
  for (std::size_t i = 0, k = trajectory.size() - 1; i < k; ++i, --k)
    std::swap(trajectory[i].pose, trajectory[k].pose);
  return trajectory;
}

/// From half of the drive on, the motions of its first half again: of another drive.
inline Trajectory half_of_another(Trajectory trajectory) {
  const std::size_t half = trajectory.size() / 2;
  const DualQuaternion start = trajectory[half].pose * conjugate(trajectory[0].pose);
  const Trajectory given = trajectory;
  for (std::size_t i = half; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(start * given[i - half].pose));
  return trajectory;
}

/// A vehicle that took another way, at the stamps that are given.
inline Trajectory of_another_drive(Trajectory trajectory) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = static_cast<int>(trajectory.size());
  options.relative_noise = 0.01;
  options.seed = 1000 + trajectory.size();
  const Trajectory other = simulated_drive(options).b;
  for (std::size_t i = 0; i < std::min(other.size(), trajectory.size()); ++i)
    trajectory[i].pose = other[i].pose;
  return trajectory;
}

/// Every n-th pose, and between them what a straight line says.
inline Trajectory interpolated(Trajectory trajectory, std::size_t n) {
  for (std::size_t i = 0; i + n < trajectory.size(); i += n) {
    const Pose from = to_pose(trajectory[i].pose), to = to_pose(trajectory[i + n].pose);
    for (std::size_t k = 1; k < n; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(n);
      const Eigen::Quaterniond q0 = from.rotation, q1 = to.rotation;
      const Eigen::Vector3d position = (1 - part) * from.translation + part * to.translation;
      trajectory[i + k].pose = canonical_sign(to_dual_quaternion({q0.slerp(part, q1), position}));
    }
  }
  return trajectory;
}

/// The odometry starts again in the middle of the drive. No mistake, but a motion that is none.
inline Trajectory restarted(Trajectory trajectory) {
  const DualQuaternion there = conjugate(trajectory[trajectory.size() / 2].pose);
  for (std::size_t i = trajectory.size() / 2; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(there * trajectory[i].pose));
  return trajectory;
}

/// A road drive of another vehicle, with the stamps of this one.
inline Trajectory of_another_vehicle(const Trajectory& trajectory) {
  SimulationOptions options;
  options.poses = static_cast<int>(trajectory.size());
  options.relative_noise = 0.01;
  options.seed = 4711;
  Trajectory other = simulated_drive(options).b;
  for (std::size_t i = 0; i < other.size(); ++i) other[i].time_us = trajectory[i].time_us;
  return other;
}

/// A slow sensor whose last pose is repeated at every stamp: one new pose in n.
inline Trajectory held(Trajectory trajectory, std::size_t n) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].pose = trajectory[i - i % n].pose;
  return trajectory;
}

/// A causal filter of first order; each pose keeps this part of the one before.
inline Trajectory low_passed(Trajectory trajectory, double kept) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const Eigen::Quaterniond q0 = before.rotation, q1 = pose.rotation;
    const Eigen::Vector3d position = kept * before.translation + (1 - kept) * pose.translation;
    trajectory[i].pose = canonical_sign(to_dual_quaternion({q0.slerp(1 - kept, q1), position}));
  }
  return trajectory;
}

}  // namespace egocal::testing
