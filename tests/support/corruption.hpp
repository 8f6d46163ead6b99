// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

/// Gross errors of real odometry. Each affects about the given part of the poses.
enum class Corruption {
  missing,         ///< one long stretch is not there: what no method can do better than
  isolated_jumps,  ///< single poses metres and tens of degrees away
  lasting_jumps,   ///< from some poses on everything is elsewhere: tracking lost and found again
  frozen_once,     ///< one long stretch repeats its first pose
  frozen_often,    ///< many stretches of up to two seconds
  swapped_axes,    ///< for a while x, y, z are y, z, x
  mirrored_axes,   ///< for a while x and y are exchanged: left-handed
  swapped_often,   ///< x, y, z are y, z, x in several short stretches
};
inline constexpr Corruption corruptions[] = {Corruption::missing,       Corruption::isolated_jumps,
                                             Corruption::lasting_jumps, Corruption::frozen_once,
                                             Corruption::frozen_often,  Corruption::swapped_axes,
                                             Corruption::mirrored_axes, Corruption::swapped_often};

inline std::string to_string(Corruption corruption) {
  constexpr const char* names[] = {"missing",      "isolated jumps", "lasting jumps", "frozen once",
                                   "frozen often", "swapped axes",   "mirrored axes", "swapped often"};
  return names[static_cast<int>(corruption)];
}

namespace detail {

inline DualQuaternion with_swapped_axes(const DualQuaternion& pose, bool mirror) {
  Eigen::Matrix3d P;
  if (mirror)
    P << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  else
    P << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Pose given = to_pose(pose);
  const Eigen::Matrix3d R = P * given.rotation.toRotationMatrix() * P.transpose();
  return to_dual_quaternion({Eigen::Quaterniond(R), P * given.translation});
}

/// Calls change(first, last) on stretches of `length` poses that cover `part` of n.
template <typename Change>
void in_stretches(std::size_t n, double part, std::size_t length, Random& random, Change change) {
  const std::size_t count =
      std::max<std::size_t>(1, static_cast<std::size_t>(part * static_cast<double>(n)) / length);
  const std::size_t slot = n / count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * slot + random.below(slot - std::min(slot - 1, length));
    change(first, std::min(n, first + length));
  }
}

}  // namespace detail

/// The trajectory with `part` of its poses grossly wrong.
inline Trajectory corrupted(Trajectory path, Corruption corruption, std::uint64_t seed, double part = 0.2) {
  Random random(seed);
  const std::size_t n = path.size();
  const auto whole = static_cast<std::size_t>(part * static_cast<double>(n));
  const double period =
      1e-6 * static_cast<double>(path.back().time_us - path.front().time_us) / static_cast<double>(n);
  const auto seconds = [&](double s) {
    return std::clamp<std::size_t>(static_cast<std::size_t>(s / period), 2, whole);
  };
  const auto elsewhere = [&] { return testing::normal_displacement(random, 2, 0.5); };
  const auto freeze = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) path[i].pose = path[first].pose;
  };
  const auto swap = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      path[i].pose = detail::with_swapped_axes(path[i].pose, corruption == Corruption::mirrored_axes);
  };
  switch (corruption) {
    case Corruption::missing:
      detail::in_stretches(n, part, whole, random, [&](std::size_t first, std::size_t last) {
        path.erase(path.begin() + static_cast<std::ptrdiff_t>(first),
                   path.begin() + static_cast<std::ptrdiff_t>(last));
      });
      break;
    case Corruption::isolated_jumps:
      for (StampedPose& pose : path)
        if (random.uniform() < part) pose.pose = normalized(pose.pose * elsewhere());
      break;
    case Corruption::lasting_jumps: {
      // a jump at every fifth pose would leave no motions at all, so one every five seconds
      DualQuaternion since;
      for (StampedPose& pose : path) {
        if (random.uniform() < 0.2 * period) since = normalized(since * elsewhere());
        pose.pose = normalized(since * pose.pose);
      }
      break;
    }
    case Corruption::frozen_once:
      detail::in_stretches(n, part, whole, random, freeze);
      break;
    case Corruption::frozen_often:
      detail::in_stretches(n, part, seconds(2), random, freeze);
      break;
    case Corruption::swapped_axes:
    case Corruption::mirrored_axes:
      detail::in_stretches(n, part, whole, random, swap);
      break;
    case Corruption::swapped_often:
      detail::in_stretches(n, part, std::max<std::size_t>(2, whole / 5), random, swap);
      break;
  }
  return path;
}

}  // namespace egocal::testing
