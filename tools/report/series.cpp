// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/series.hpp"
#include "degrees.hpp"
#include "egocal/microseconds.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace egocal::tools {

namespace {

/// Pose at a time, by screw interpolation; the ends outside of the trajectory.
Pose pose_at(const Trajectory& trajectory, std::int64_t time_us) {
  const auto later =
      std::lower_bound(trajectory.begin(), trajectory.end(), time_us,
                       [](const StampedPose& pose, std::int64_t t) { return pose.time_us < t; });
  if (later == trajectory.begin()) return to_pose(trajectory.front().pose);
  if (later == trajectory.end()) return to_pose(trajectory.back().pose);
  const StampedPose &before = *std::prev(later), &after = *later;
  const double s =
      static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us);
  return to_pose(interpolate(before.pose, after.pose, s));
}

}  // namespace

Residuals residuals_of(const std::vector<MotionPair>& pairs, const Pose& T_a_b) {
  Residuals result;
  if (pairs.empty()) return result;
  const Pose T_b_a = inverse(T_a_b);
  for (const MotionPair& pair : pairs) {
    const Pose residual = inverse(to_pose(pair.a)) * (T_a_b * to_pose(pair.b) * T_b_a);
    result.time.push_back(seconds_between(pairs.front().end_us, pair.end_us));
    result.rotation.push_back(rotation_log(residual.rotation).norm() * degrees);
    result.translation.push_back(residual.translation.norm());
  }
  return result;
}

Map map_of(const Trajectory& a, const Trajectory& b, const Pose& T_a_b) {
  Map map;
  if (a.empty() || b.empty()) return map;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : a) mean += to_pose(pose.pose).translation / static_cast<double>(a.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const StampedPose& pose : a) {
    const Eigen::Vector3d offset = to_pose(pose.pose).translation - mean;
    spread += offset * offset.transpose();
  }
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  const Eigen::Vector3d across = axes.col(2), up = axes.col(1);
  for (const StampedPose& pose : a) {
    const Eigen::Vector3d p = to_pose(pose.pose).translation - mean;
    map.a_x.push_back(across.dot(p));
    map.a_y.push_back(up.dot(p));
  }
  // the start frames are joined where both streams begin
  const std::int64_t begin = std::max(a.front().time_us, b.front().time_us);
  const Pose T_b_a = inverse(T_a_b);
  const Pose join = pose_at(a, begin) * T_a_b * inverse(pose_at(b, begin));
  for (const StampedPose& pose : b) {
    const Eigen::Vector3d p = (join * to_pose(pose.pose) * T_b_a).translation - mean;
    map.b_x.push_back(across.dot(p));
    map.b_y.push_back(up.dot(p));
  }
  return map;
}

Progress progress_of(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                     int points) {
  Progress progress;
  if (a.empty() || b.empty() || points < 1) return progress;
  CalibrationOptions fixed = options;
  fixed.estimate_time_offset = false;
  Calibrator calibrator(fixed);
  const std::size_t step = std::max<std::size_t>(1, a.size() / static_cast<std::size_t>(points));
  std::size_t j = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (; j < b.size() && b[j].time_us < a[i].time_us; ++j) calibrator.add(Side::b, b[j]);
    calibrator.add(Side::a, a[i]);
    if (i % step != step - 1) continue;
    const std::optional<Calibration> calibration = calibrator.answer();
    if (!calibration) continue;
    progress.time.push_back(seconds_between(a.front().time_us, a[i].time_us));
    for (std::size_t k = 0; k < 6; ++k) progress.stddev[k].push_back(calibration->observability.stddev[k]);
  }
  return progress;
}

Excitation excitation_of(const Trajectory& a) {
  constexpr std::int64_t shortest_us = 100'000;  // rates over less are noise
  Excitation result;
  std::size_t from = 0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    const Pose motion = inverse(to_pose(a[i - 1].pose)) * to_pose(a[i].pose);
    result.path += motion.translation.norm();
    if (a[i].time_us - a[from].time_us < shortest_us) continue;
    const double duration = seconds_between(a[from].time_us, a[i].time_us);
    const Eigen::Quaterniond turned =
        to_pose(a[from].pose).rotation.conjugate() * to_pose(a[i].pose).rotation;
    const Eigen::Vector3d rate = rotation_log(turned) * degrees / duration;
    result.time.push_back(seconds_between(a.front().time_us, a[i].time_us));
    for (int k = 0; k < 3; ++k) result.turning[k].push_back(rate[k]);
    from = i;
  }
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (const double rate : result.turning[k]) sum += rate * rate;
    result.root_mean_square[k] =
        std::sqrt(sum / std::max(1.0, static_cast<double>(result.turning[k].size())));
  }
  return result;
}

}  // namespace egocal::tools
