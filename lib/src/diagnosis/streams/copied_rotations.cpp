// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/copied_rotations.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/timed_poses.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Rotation of a stream at a time of the other stream; empty where no two poses are around it.
std::optional<Rotation> rotation_at(const TimedPoses& stream, double time, double max_gap) {
  std::size_t from = 0, to = stream.times.size();  // the first pose after the time is in [from, to]
  while (from < to) {
    const std::size_t middle = from + (to - from) / 2;
    if (stream.times[middle] > time)
      to = middle;
    else
      from = middle + 1;
  }
  if (from == 0) return std::nullopt;
  const double before = stream.times[from - 1];
  const Rotation here = to_pose(stream.poses[from - 1].pose).rotation;
  if (before == time) return here;
  if (from == stream.times.size() || stream.times[from] - before > max_gap) return std::nullopt;
  return here.slerp((time - before) / (stream.times[from] - before),
                    to_pose(stream.poses[from].pose).rotation);
}

bool are_copies(const TimedPoses& rows, const TimedPoses& others, double max_gap,
                const CopiedRotationsOptions& options) {
  std::vector<double> angles, differences;
  std::optional<std::pair<Rotation, Rotation>> last;
  const std::size_t each = (rows.poses.size() + options.looked_at - 1) / options.looked_at;
  for (std::size_t i = 0; i < rows.poses.size(); i += each) {
    const std::optional<Rotation> other = rotation_at(others, rows.times[i], max_gap);
    if (!other) continue;
    const Rotation own = to_pose(rows.poses[i].pose).rotation;
    if (last) {
      const double of_own = rotation_log(last->first.conjugate() * own).norm(),
                   of_other = rotation_log(last->second.conjugate() * *other).norm();
      angles.push_back(of_own);
      differences.push_back(std::abs(of_own - of_other));
    }
    last = {own, *other};
  }
  return angles.size() >= options.fewest && median(std::move(differences)) <= options.of_rounding &&
         median(std::move(angles)) >= options.turning;
}

Finding rotations_of_one() {
  Finding finding;
  finding.code = "same_stream";
  finding.message =
      "Both streams turn by the same angles to rounding, as two sensors never do: the rotations of one were "
      "made from the other's, or both are of a third sensor. The rotation of the answer is the one that was "
      "put in.";
  finding.remedy =
      "Give what each sensor measured by itself; ignore this where the rotations were simulated without "
      "noise.";
  return finding;
}

}  // namespace

std::optional<Finding> copied_rotations(const Trajectory& a, const Trajectory& b, const ClockModel& clock,
                                        double max_gap, const CopiedRotationsOptions& options) {
  if (a.empty() || b.empty()) return std::nullopt;
  const TimedPoses of_a{a, Times(a, a.front().time_us, ClockModel{})},
      of_b{b, Times(b, a.front().time_us, clock)};
  if (!are_copies(of_b, of_a, max_gap, options) && !are_copies(of_a, of_b, max_gap, options))
    return std::nullopt;
  return rotations_of_one();
}

std::optional<Finding> exactly_copied_rotations(const Fit& fit, const Motions& motions,
                                                const CopiedRotationsOptions& options) {
  if (!(fit.rotation_median < options.exact) || !(motions.rotation > options.turning)) return std::nullopt;
  return rotations_of_one();
}

}  // namespace egocal::detail
