// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/series.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "egocal/degrees.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::tools {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

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

Residuals residuals_of(const std::vector<MotionPair>& pairs, const Pose& T_a_b, const DrawnTime& time) {
  Residuals result;
  const Pose T_b_a = inverse(T_a_b);
  for (const MotionPair& pair : pairs) {
    const Pose residual = inverse(to_pose(pair.a)) * (T_a_b * to_pose(pair.b) * T_b_a);
    result.time.push_back(time.seconds(pair.end_us));
    result.rotation.push_back(rotation_log(residual.rotation).norm() * degrees_per_radian);
    result.translation.push_back(residual.translation.norm());
  }
  return result;
}

Map map_of(const Trajectory& a, const Trajectory& b, const Pose& T_a_b, const DrawnTime& time) {
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
  const auto add = [&](const Eigen::Vector3d& p, std::vector<double>& x, std::vector<double>& y) {
    x.push_back(across.dot(p - mean));
    y.push_back(up.dot(p - mean));
  };
  const auto interrupt = [](std::vector<double>& x, std::vector<double>& y) {
    x.push_back(not_a_number);
    y.push_back(not_a_number);
  };
  std::vector<std::int64_t> begins;  // of a's parts [us]
  for (const StampedPose& pose : a) {
    if (time.part_of(pose.time_us) >= begins.size()) {
      if (!begins.empty()) interrupt(map.a_x, map.a_y);
      begins.push_back(pose.time_us);
    }
    add(to_pose(pose.pose).translation, map.a_x, map.a_y);
  }
  const Pose T_b_a = inverse(T_a_b);
  // the start frames are joined where both streams begin, in each part anew
  std::optional<std::size_t> part;
  Pose join;
  for (const StampedPose& pose : b) {
    if (const std::size_t at = std::min(time.part_of(pose.time_us), begins.size() - 1); part != at) {
      if (part) interrupt(map.b_x, map.b_y);
      part = at;
      const std::int64_t begin = std::max(begins[at], pose.time_us);
      join = pose_at(a, begin) * T_a_b * inverse(pose_at(b, begin));
    }
    add((join * to_pose(pose.pose) * T_b_a).translation, map.b_x, map.b_y);
  }
  return map;
}

Progress progress_of(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options, int points,
                     const DrawnTime& time) {
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
    progress.time.push_back(time.seconds(a[i].time_us));
    for (std::size_t k = 0; k < 6; ++k) progress.stddev[k].push_back(calibration->observability.stddev[k]);
  }
  return progress;
}

Excitation excitation_of(const Trajectory& a, const DrawnTime& time) {
  constexpr std::int64_t shortest_us = 100'000;  // rates over less are noise
  Excitation result;
  std::size_t from = 0;
  const auto add = [&](double at, const Eigen::Vector3d& rate) {
    result.time.push_back(at);
    for (int k = 0; k < 3; ++k) result.turning[k].push_back(rate[k]);
  };
  double squares[3] = {0, 0, 0};
  std::size_t count = 0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (time.part_of(a[i].time_us) != time.part_of(a[i - 1].time_us)) {
      add(not_a_number, Eigen::Vector3d::Constant(not_a_number));
      from = i;
      continue;
    }
    const Pose motion = inverse(to_pose(a[i - 1].pose)) * to_pose(a[i].pose);
    result.path += motion.translation.norm();
    if (a[i].time_us - a[from].time_us < shortest_us) continue;
    const double duration = seconds_between(a[from].time_us, a[i].time_us);
    const Eigen::Quaterniond turned =
        to_pose(a[from].pose).rotation.conjugate() * to_pose(a[i].pose).rotation;
    const Eigen::Vector3d rate = rotation_log(turned) * degrees_per_radian / duration;
    add(time.seconds(a[i].time_us), rate);
    for (int k = 0; k < 3; ++k) squares[k] += rate[k] * rate[k];
    ++count;
    from = i;
  }
  for (int k = 0; k < 3; ++k)
    result.root_mean_square[k] = std::sqrt(squares[k] / std::max(1.0, static_cast<double>(count)));
  return result;
}

}  // namespace egocal::tools
