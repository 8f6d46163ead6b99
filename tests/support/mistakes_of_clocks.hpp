// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Stamps of other clocks, and values that are late or held.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::testing {

/// Stamps later by offset [s] and growing by rate [s/s].
inline Trajectory late(Trajectory trajectory, double offset, double rate = 0) {
  const std::int64_t first = trajectory.front().time_us;
  for (StampedPose& pose : trajectory)
    pose.time_us += std::llround(1e6 * offset + rate * static_cast<double>(pose.time_us - first));
  return trajectory;
}

/// Stamps rounded down to whole multiples [us], as a number with few digits keeps them.
inline Trajectory with_rounded_stamps(Trajectory trajectory, std::int64_t multiple) {
  const std::int64_t first = trajectory.front().time_us;
  for (StampedPose& pose : trajectory) pose.time_us -= (pose.time_us - first) % multiple;
  Trajectory result;
  for (const StampedPose& pose : trajectory)
    if (result.empty() || pose.time_us > result.back().time_us) result.push_back(pose);
  return result;
}

/// From the middle of the drive on, stamps later by this [us].
inline Trajectory late_from_the_middle(Trajectory trajectory, std::int64_t later) {
  for (std::size_t i = trajectory.size() / 2; i < trajectory.size(); ++i) trajectory[i].time_us += later;
  return trajectory;
}

enum class Half { positions, rotations };

/// The trajectory with that half of each pose as it was the given number of poses before.
template <typename PosesBefore>
Trajectory with_half_of_earlier(const Trajectory& trajectory, Half half, const PosesBefore& poses_before) {
  Trajectory result = trajectory;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    Pose pose = to_pose(trajectory[i].pose);
    const Pose earlier = to_pose(trajectory[i - poses_before(i)].pose);
    if (half == Half::positions)
      pose.translation = earlier.translation;
    else
      pose.rotation = earlier.rotation;
    result[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  return result;
}

inline Trajectory with_late(const Trajectory& trajectory, Half half, std::size_t poses) {
  return with_half_of_earlier(trajectory, half, [poses](std::size_t i) { return std::min(i, poses); });
}

/// Positions as they were some poses before: of another sensor than the rotations, with a delay.
inline Trajectory with_late_positions(const Trajectory& trajectory, std::size_t poses) {
  return with_late(trajectory, Half::positions, poses);
}

/// The same of the rotations.
inline Trajectory with_late_rotations(const Trajectory& trajectory, std::size_t poses) {
  return with_late(trajectory, Half::rotations, poses);
}

inline Trajectory with_held(const Trajectory& trajectory, Half half, std::size_t n) {
  return with_half_of_earlier(trajectory, half, [n](std::size_t i) { return i % n; });
}

/// Positions of a slow receiver, each held for n rows of fast rotations.
inline Trajectory with_held_positions(const Trajectory& trajectory, std::size_t n) {
  return with_held(trajectory, Half::positions, n);
}

/// The same of the rotations.
inline Trajectory with_held_rotations(const Trajectory& trajectory, std::size_t n) {
  return with_held(trajectory, Half::rotations, n);
}

}  // namespace egocal::testing
