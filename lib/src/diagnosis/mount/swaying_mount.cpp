// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/swaying_mount.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Squared changes [rad^2] over `steps` instants, none across a gap.
std::vector<double> squared_changes(const Instants& instants, const DualQuaternion& T_a_b, std::size_t steps,
                                    const MotionSampleOptions& motions, const SwayOptions& options) {
  std::vector<double> squares;
  const std::size_t each = std::max<std::size_t>(1, (instants.size() - steps) / options.most_motions);
  const double longest = motions.most_stretched * static_cast<double>(steps) * instants.period;
  MotionEnds ends(instants, {}, {}, steps, each);
  for (std::size_t i = 0; i + steps < instants.size(); i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k) - instants.time(i) > longest) continue;
    ends.fetch_next(i, k);
    const PosePair from = ends.at(i), to = ends.at(k);
    const Pose change =
        to_pose(conjugate(T_a_b) * conjugate(from.a) * to.a * T_a_b * conjugate(conjugate(from.b) * to.b));
    squares.push_back(rotation_log(change.rotation).squaredNorm());
  }
  return squares;
}

/// Mean of the squared changes without the largest ones (SwayOptions::largest_part).
double mean_square(std::vector<double> squares, const SwayOptions& options) {
  const auto count =
      static_cast<std::size_t>(std::ceil((1 - options.largest_part) * static_cast<double>(squares.size())));
  if (count < squares.size()) order_statistic_in_place(squares, count);
  return std::accumulate(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

}  // namespace

double mean_square_by_interpolation(const Instants& instants, std::size_t poses, const SwayOptions& options) {
  const Instants other = instants.through(poses);
  const std::size_t each = std::max<std::size_t>(1, instants.size() / options.most_motions);
  std::vector<double> squares;
  for (std::size_t i = 0; i < instants.size(); i += each) {
    if (!instants.between_poses(i)) continue;
    const PosePair here = instants.at(i), there = other.at(i);
    squares.push_back(rotation_log(to_pose(conjugate(here.a) * there.a).rotation).squaredNorm() +
                      rotation_log(to_pose(conjugate(here.b) * there.b).rotation).squaredNorm());
  }
  return squares.empty() ? 0 : mean_square(std::move(squares), options);
}

std::vector<RotationChange> rotation_changes(const Instants& instants, const DualQuaternion& T_a_b,
                                             const MotionSampleOptions& motions, const SwayOptions& options) {
  std::vector<RotationChange> changes;
  const auto most = static_cast<std::size_t>(options.longest_stride * static_cast<double>(instants.size()));
  for (std::size_t steps = 1; steps <= most;
       steps = std::max(steps + 1, static_cast<std::size_t>(
                                       std::lround(options.next_stride * static_cast<double>(steps))))) {
    std::vector<double> squares = squared_changes(instants, T_a_b, steps, motions, options);
    if (squares.size() < options.least_motions) continue;
    changes.push_back(
        {static_cast<double>(steps) * instants.period, mean_square(std::move(squares), options)});
  }
  return changes;
}

std::optional<RotationChange> sway(const std::vector<RotationChange>& changes, const SwayOptions& options) {
  const auto squared = [](double x) { return x * x; };
  std::optional<RotationChange> largest;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const RotationChange& here = changes[k];
    if (here.time > options.longest_time || here.mean_square < squared(options.least)) continue;
    if (largest && largest->mean_square >= here.mean_square) continue;
    const auto until = [&](double times) {
      return std::find_if(changes.begin(), changes.end(),
                          [&](const RotationChange& one) { return one.time > times * here.time; });
    };
    const auto smaller = [](const RotationChange& x, const RotationChange& y) {
      return x.mean_square < y.mean_square;
    };
    const auto before = until(options.before);
    if (before == changes.begin() ||
        std::prev(before)->mean_square > squared(options.most_before) * here.mean_square)
      continue;
    const auto next = changes.begin() + static_cast<std::ptrdiff_t>(k) + 1;
    if (next == changes.end()) continue;
    const bool far_enough = changes.back().time >= options.flat_until * here.time;
    const bool flat = far_enough && std::max_element(next, until(options.looked_at), smaller)->mean_square <=
                                        squared(options.most_after) * here.mean_square;
    const auto soon = until(options.flat_until);
    const bool falls = soon != next && std::min_element(next, soon, smaller)->mean_square <=
                                           squared(options.fallen) * here.mean_square;
    if (flat || falls) largest = here;
  }
  return largest;
}

std::optional<Finding> swaying_mount(const Instants& instants, const Answered& answered,
                                     const DiagnosisOptions& options) {
  const SwayOptions tuning;
  const std::optional<RotationChange> found =
      sway(rotation_changes(instants, answered.T_a_b, options.motions, tuning), tuning);
  if (!found) return std::nullopt;
  const double sways = std::sqrt(found->mean_square),
               interpolation =
                   std::sqrt(mean_square_by_interpolation(instants, options.undersampling.poses, tuning));
  if (sways < tuning.of_interpolation * interpolation) return std::nullopt;
  Finding finding;
  finding.code = "mount_moved";
  finding.message = format(
      "The rotation between the sensors changes by %.2g deg within %.2g s, and by no more in a longer time: "
      "the mounting shakes, or the rotations of a stream do.",
      sways * degrees_per_radian, found->time);
  finding.remedy = "Fasten the mounting, or check the filter that makes the rotations, and record again.";
  return finding;
}

}  // namespace egocal::detail
