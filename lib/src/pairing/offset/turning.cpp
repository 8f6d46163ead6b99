// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/turning.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "egocal/geometry/pose.hpp"
#include "egocal/limits.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

double angle_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond turn = from.conjugate() * to;
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

Eigen::Quaterniond rotation_of(const StampedPose& pose) {
  const Eigen::Vector4d& r = pose.pose.real;
  return {r[0], r[1], r[2], r[3]};
}

/// Rotation at a time; empty where not known.
std::optional<Eigen::Quaterniond> rotation_at(const Trajectory& trajectory, std::int64_t time_us,
                                              std::int64_t max_gap_us, std::size_t& from) {
  while (from + 1 < trajectory.size() && trajectory[from + 1].time_us <= time_us) ++from;
  if (from + 1 >= trajectory.size() || trajectory[from].time_us > time_us) return std::nullopt;
  const StampedPose &before = trajectory[from], &after = trajectory[from + 1];
  if (after.time_us - before.time_us > max_gap_us) return std::nullopt;
  const double part =
      static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us);
  return rotation_of(before).slerp(part, rotation_of(after));
}

}  // namespace

std::int64_t median_period_us(const Trajectory& trajectory) {
  std::vector<std::int64_t> periods;
  periods.reserve(trajectory.size());
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    periods.push_back(trajectory[i].time_us - trajectory[i - 1].time_us);
  return std::max<std::int64_t>(1, median(std::move(periods)));
}

std::size_t thin(Trajectory& trajectory, std::size_t begin, std::size_t end, std::size_t kept,
                 std::int64_t least_us) {
  for (std::size_t i = begin; i < end; ++i) {
    const StampedPose pose = trajectory[i];
    if (!plausible_relative_time(pose.time_us) || !pose.pose.vec().allFinite() ||
        !plausible_norm(pose.pose.real.norm()))
      continue;
    if (kept == 0 || pose.time_us - trajectory[kept - 1].time_us >= least_us)
      trajectory[kept++] = {pose.time_us, normalized(pose.pose)};
  }
  return kept;
}

Trajectory thinned(Trajectory trajectory, std::int64_t least_us) {
  trajectory.resize(thin(trajectory, 0, trajectory.size(), 0, least_us));
  return trajectory;
}

Trajectory dense_part(Trajectory trajectory, std::int64_t max_gap_us, std::int64_t most_sparse) {
  std::int64_t known_us = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const std::int64_t gap = trajectory[i].time_us - trajectory[i - 1].time_us;
    if (gap <= max_gap_us) known_us += gap;
  }
  std::size_t begin = 0, best_begin = 0, best_end = 0;
  for (std::size_t end = 1; end <= trajectory.size(); ++end) {
    while (trajectory[end - 1].time_us - trajectory[begin].time_us > most_sparse * known_us) ++begin;
    if (end - begin > best_end - best_begin) {
      best_begin = begin;
      best_end = end;
    }
  }
  trajectory.erase(trajectory.begin() + static_cast<std::ptrdiff_t>(best_end), trajectory.end());
  trajectory.erase(trajectory.begin(), trajectory.begin() + static_cast<std::ptrdiff_t>(best_begin));
  return trajectory;
}

Detour detour(const Trajectory& trajectory, std::size_t i) {
  if (i == 0 || i + 1 >= trajectory.size()) return {};
  const Eigen::Quaterniond r0 = rotation_of(trajectory[i - 1]), r1 = rotation_of(trajectory[i]),
                           r2 = rotation_of(trajectory[i + 1]);
  const Eigen::Vector3d p0 = to_pose(trajectory[i - 1].pose).translation,
                        p1 = to_pose(trajectory[i].pose).translation,
                        p2 = to_pose(trajectory[i + 1].pose).translation;
  Detour result;
  result.past_angle = angle_between(r0, r2);
  result.past_length = (p2 - p0).norm();
  result.angle = std::max(0.0, angle_between(r0, r1) + angle_between(r1, r2) - result.past_angle);
  result.length = std::max(0.0, (p1 - p0).norm() + (p2 - p1).norm() - result.past_length);
  return result;
}

double median_of(const std::vector<Detour>& detours, double Detour::*member) {
  std::vector<double> values;
  values.reserve(detours.size());
  for (const Detour& one : detours) values.push_back(one.*member);
  return median(std::move(values));
}

bool is_glitch(const std::vector<Detour>& detours, std::size_t i, const Detour& typical,
               const TimeOffsetOptions& options) {
  const double angle = options.outlier * typical.angle, length = options.outlier * typical.length;
  // how far off a pose is, by angle or length, whichever is larger; 1 is the limit
  const auto excess = [&](const Detour& one) {
    const double by_angle =
        one.angle / std::max({angle, options.least_detour * one.past_angle, options.angle_floor});
    const double by_length =
        one.length / std::max({length, options.least_detour * one.past_length, options.length_floor});
    return std::max(by_angle, by_length);
  };
  const double here = excess(detours[i]);
  const bool furthest = (i == 0 || here >= excess(detours[i - 1])) &&
                        (i + 1 == detours.size() || here >= excess(detours[i + 1]));
  return here > 1 && furthest;
}

std::size_t grid_size(const Trajectory& trajectory, std::int64_t step_us) {
  return static_cast<std::size_t>((trajectory.back().time_us - trajectory.front().time_us) / step_us + 1);
}

double turn_at(const Trajectory& trajectory, std::size_t k, std::int64_t step_us, std::int64_t max_gap_us,
               std::size_t& from) {
  const std::int64_t begin = trajectory.front().time_us + static_cast<std::int64_t>(k) * step_us;
  const auto first = rotation_at(trajectory, begin, max_gap_us, from);
  std::size_t ahead = from;
  const auto last = rotation_at(trajectory, begin + 2 * step_us, max_gap_us, ahead);
  return first && last ? angle_between(*first, *last) : -1;
}

void limit_largest(Series& angles) {
  std::vector<double> known;
  for (const double angle : angles)
    if (angle >= 0) known.push_back(angle);
  if (known.empty()) return;
  // the largest 3 % are also the turns of a mostly straight drive, so they keep some of their size
  const double most = order_statistic_in_place(known, known.size() * 97 / 100);
  const double limit = most > 0 ? 2 * most : *std::max_element(known.begin(), known.end());
  for (double& angle : angles) angle = std::min(angle, limit);
}

}  // namespace egocal::detail
