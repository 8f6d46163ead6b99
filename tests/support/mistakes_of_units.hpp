// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths and angles in other units, or with a factor; velocities in place of positions.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "mistakes_of_frames.hpp"

namespace egocal::testing {

/// Headings of a compass that turns `factor` times as far as it should, about the axis of its world that most
/// of the turning is about: the vertical. Positions are right.
inline Trajectory with_turning_scale(Trajectory trajectory, double factor) {
  std::vector<Eigen::Vector3d> turns{Eigen::Vector3d::Zero()};
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    turns.push_back(rotation_log(to_pose(trajectory[i].pose).rotation *
                                 to_pose(trajectory[i - 1].pose).rotation.conjugate()));
  Eigen::Vector3d axis(0.3, 0.5, 0.8);
  for (int round = 0; round < 100; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& turn : turns) sum += axis.dot(turn) * turn;
    axis = sum.normalized();
  }
  double turned = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    turned += axis.dot(turns[i]);
    const Pose pose = to_pose(trajectory[i].pose);
    trajectory[i].pose = canonical_sign(to_dual_quaternion(
        Pose{rotation_exp((factor - 1) * turned * axis) * pose.rotation, pose.translation}));
  }
  return trajectory;
}

inline Trajectory lengthened(const Trajectory& trajectory, double factor) {
  return changed(trajectory, [=](const Pose& pose) {
    return Pose{pose.rotation, factor * pose.translation};
  });
}

/// Rotation vectors in degrees, read as radians.
inline Trajectory with_angles_in_degrees(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Vector3d turned = 180 / std::numbers::pi * rotation_log(pose.rotation);
    return Pose{rotation_exp(turned), pose.translation};
  });
}

/// Each step turned by a factor, and summed up with the wrong rotations: half or double angles of a
/// gyroscope.
inline Trajectory with_scaled_steps(const Trajectory& trajectory, double factor) {
  Trajectory result = trajectory;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    Pose step = to_pose(conjugate(trajectory[i - 1].pose) * trajectory[i].pose);
    step.rotation = rotation_exp(factor * rotation_log(step.rotation));
    result[i].pose = canonical_sign(normalized(result[i - 1].pose * to_dual_quaternion(step)));
  }
  return result;
}

/// Velocities in the axes of the world [m/s] where positions should be.
inline Trajectory with_velocities(const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const double seconds = 1e-6 * static_cast<double>(trajectory[i].time_us - trajectory[i - 1].time_us);
    result[i].pose = canonical_sign(
        to_dual_quaternion({pose.rotation, (pose.translation - before.translation) / seconds}));
  }
  if (result.size() > 1) result[0].pose = result[1].pose;
  return result;
}

/// The scale of each motion grows evenly by `growth` over the drive.
inline Trajectory with_growing_scale(const Trajectory& trajectory, double growth) {
  Trajectory result = trajectory;
  Eigen::Vector3d position = to_pose(trajectory.front().pose).translation;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const double part = static_cast<double>(i) / static_cast<double>(trajectory.size());
    position += (1 + growth * part) * (pose.translation - before.translation);
    result[i].pose = canonical_sign(to_dual_quaternion({pose.rotation, position}));
  }
  return result;
}

/// From the middle of the drive on, every motion longer by this factor.
inline Trajectory longer_from_the_middle(Trajectory trajectory, double factor) {
  const std::size_t middle = trajectory.size() / 2;
  const Eigen::Vector3d there = to_pose(trajectory[middle].pose).translation;
  for (std::size_t i = middle; i < trajectory.size(); ++i) {
    const Pose pose = to_pose(trajectory[i].pose);
    const Eigen::Vector3d position = there + factor * (pose.translation - there);
    trajectory[i].pose = canonical_sign(to_dual_quaternion({pose.rotation, position}));
  }
  return trajectory;
}

}  // namespace egocal::testing
