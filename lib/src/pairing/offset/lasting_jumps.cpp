// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/lasting_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/motions/instant.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Velocities from one pose to the next one.
struct Step {
  double seconds = 0;
  Eigen::Vector3d turning, speed;  ///< [rad/s, m/s]
};

Step step_from(const Trajectory& trajectory, std::size_t i) {
  const Pose motion = to_pose(motion_between(trajectory[i].pose, trajectory[i + 1].pose));
  const double seconds = static_cast<double>(trajectory[i + 1].time_us - trajectory[i].time_us) / 1e6;
  return {seconds, rotation_log(motion.rotation) / seconds, motion.translation / seconds};
}

}  // namespace

StepDifference step_difference(const Trajectory& trajectory, std::size_t i, std::int64_t max_gap_us) {
  if (i == 0 || i + 2 >= trajectory.size()) return {};
  for (std::size_t k = i - 1; k < i + 2; ++k) {
    const std::int64_t time_us = trajectory[k + 1].time_us - trajectory[k].time_us;
    if (time_us <= 0 || time_us > max_gap_us) return {};
  }
  const Step before = step_from(trajectory, i - 1), here = step_from(trajectory, i),
             after = step_from(trajectory, i + 1);
  return {here.seconds * (here.turning - 0.5 * (before.turning + after.turning)).norm(),
          here.seconds * (here.speed - 0.5 * (before.speed + after.speed)).norm(),
          here.seconds * std::max(before.turning.norm(), after.turning.norm()),
          here.seconds * std::max(before.speed.norm(), after.speed.norm()), true};
}

Trajectory without_lasting_jumps(const Trajectory& trajectory, const std::vector<StepDifference>& differences,
                                 const LastingJumpOptions& options) {
  std::vector<double> angles, lengths;
  for (const StepDifference& one : differences)
    if (one.known) {
      angles.push_back(one.angle);
      lengths.push_back(one.length);
    }
  if (angles.empty()) return trajectory;
  const double angle = std::max(options.angle_floor, options.outlier * median(std::move(angles))),
               length = std::max(options.length_floor, options.outlier * median(std::move(lengths)));
  // above 1 a jump
  const auto excess = [&](const StepDifference& one) {
    return std::max(one.angle / std::max(angle, options.least_part * one.neighbour_angle),
                    one.length / std::max(length, options.least_part * one.neighbour_length));
  };
  std::vector<std::size_t> jumps;
  for (std::size_t i = 1; i + 1 < differences.size(); ++i) {
    const double here = excess(differences[i]);
    // the neighbours of a jump differ from their means by half of it
    if (here > 1 && here >= excess(differences[i - 1]) && here >= excess(differences[i + 1]))
      jumps.push_back(i);
  }
  if (static_cast<double>(jumps.size()) > options.most * static_cast<double>(differences.size()))
    return trajectory;
  Trajectory result = trajectory;
  for (std::size_t k = 0; k < jumps.size(); ++k) {
    const std::size_t i = jumps[k];
    const Step before = step_from(trajectory, i - 1), after = step_from(trajectory, i + 1);
    const double half = 0.5 * step_from(trajectory, i).seconds;
    const DualQuaternion motion = to_dual_quaternion(
        {rotation_exp(half * (before.turning + after.turning)), half * (before.speed + after.speed)});
    // from the given poses to those of the result, in the world
    const DualQuaternion follows = normalized(result[i].pose * motion * conjugate(trajectory[i + 1].pose));
    const std::size_t end = k + 1 < jumps.size() ? jumps[k + 1] + 1 : result.size();
    for (std::size_t j = i + 1; j < end; ++j)
      result[j].pose = canonical_sign(normalized(follows * trajectory[j].pose));
  }
  return result;
}

}  // namespace egocal::detail
