// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/ends_of_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "diagnosis/explanations/measured_part.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/microseconds.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;

/// Poses between two others.
struct OnLine {
  std::vector<bool> positions, rotations;
};

OnLine on_lines(const Trajectory& poses, const EndsOfLinesOptions& options) {
  OnLine result;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double before = to_seconds(poses[i].time_us - poses[i - 1].time_us),
                 after = to_seconds(poses[i + 1].time_us - poses[i].time_us);
    const double ratio = after > 0 ? before / after : 1;
    const Pose x = to_pose(poses[i - 1].pose), y = to_pose(poses[i].pose), z = to_pose(poses[i + 1].pose);
    const auto straight = [&](const Vector3d& here, const Vector3d& next) {
      return (ratio * next - here).norm() < options.lines.straight * here.norm() + options.lines.digits;
    };
    const Vector3d moved = y.translation - x.translation, moves = z.translation - y.translation;
    // along a line of the world, or along a screw
    result.positions.push_back(straight(moved, moves) ||
                               straight(x.rotation.conjugate() * moved, y.rotation.conjugate() * moves));
    result.rotations.push_back(straight(rotation_log(x.rotation.conjugate() * y.rotation),
                                        rotation_log(y.rotation.conjugate() * z.rotation)));
  }
  return result;
}

Trajectory ends_of(const Trajectory& poses, const EndsOfLinesOptions& options) {
  const OnLine lines = on_lines(poses, options);
  const auto interpolated = [&](const std::vector<bool>& straight) {
    return static_cast<double>(std::count(straight.begin(), straight.end(), true)) >=
           options.lines.part * static_cast<double>(straight.size());
  };
  const bool positions = interpolated(lines.positions), rotations = interpolated(lines.rotations);
  Trajectory ends;
  for (std::size_t i = 0; i < lines.positions.size(); ++i)
    if (!(positions && lines.positions[i]) && !(rotations && lines.rotations[i]))
      ends.push_back(poses[i + 1]);
  return ends;
}

/// The extrinsic without the motions of one part of the time; of all for part = parts.
DualQuaternion fitted_without(std::size_t part, std::size_t parts, const Motions& motions,
                              const RobustFitOptions& options) {
  Motions kept = motions;
  const double begin = motions.all.front().time, length = motions.all.back().time - begin;
  const double from = begin + length * static_cast<double>(part) / static_cast<double>(parts),
               to = begin + length * static_cast<double>(part + 1) / static_cast<double>(parts);
  std::erase_if(kept.all, [&](const Motion& one) { return one.time >= from && one.time < to; });
  return robust_fit(part < parts ? kept : motions, options).T;
}

}  // namespace

std::array<double, 6> lost_on_lines(const Evidence& evidence, Side side, double max_gap,
                                    const Answered& answered, const DiagnosisOptions& options,
                                    const EndsOfLinesOptions& lines) {
  std::array<double, 6> stddev{};
  const Trajectory ends = ends_of(side == Side::a ? evidence.streams.a : evidence.streams.b, lines);
  if (ends.size() < lines.least) return stddev;
  const Motions motions = motions_of_part(ends, side, evidence, evidence.clock, max_gap, options);
  if (motions.all.size() < lines.least) return stddev;
  const auto change_without = [&](std::size_t part) {
    return frame_a_difference(answered.T_a_b, fitted_without(part, lines.parts, motions, options.fit));
  };
  const Vector6d change = change_without(lines.parts);
  std::vector<Vector6d> without;
  Vector6d mean = Vector6d::Zero();
  for (std::size_t part = 0; part < lines.parts; ++part) {
    without.push_back(change_without(part));
    mean += without.back() / static_cast<double>(lines.parts);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    if (!answered.observability.observable[i]) continue;
    const auto k = static_cast<Eigen::Index>(i);
    double variance = 0;
    for (const Vector6d& one : without) variance += (one[k] - mean[k]) * (one[k] - mean[k]);
    variance *= static_cast<double>(lines.parts - 1) / static_cast<double>(lines.parts);
    const double of_answer = answered.observability.stddev[i];
    const double by_chance = lines.significant * lines.significant * variance + of_answer * of_answer;
    if (const double more = change[k] * change[k] - by_chance; more > 0) stddev[i] = std::sqrt(more);
  }
  return stddev;
}

}  // namespace egocal::detail
