// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/following_mount.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/mount/swaying_mount.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

using Behaviour = Eigen::Matrix<double, 6, 1>;  ///< turning rate [rad/s], acceleration [m/s^2], in b's frame
using BehaviourCourse = Eigen::Matrix<double, 12, 1>;  ///< sizes and signs of it

using FollowingRelation =
    Eigen::Matrix<double, 36, 1>;  ///< columns of the 3 x 12 numbers from a course to a rotation
using FollowedRows = Eigen::Matrix<double, 3, 36>;

/// Change of the rotation between the sensors over a motion, in the frame of b at the begin of the motion
/// [rad], and what b does. Where b is turned by d before the motion and by e after it, the change is
/// d - turned * e.
struct FollowedChange {
  Eigen::Vector3d rotation;
  Eigen::Matrix3d turned;  ///< by b over the motion
  Behaviour before, after;

  Eigen::Vector3d by_clock() const { return before.head<3>() - turned * after.head<3>(); }
};

/// Behaviour of b at instant i, as one of the sensors sees it, from `window` instants on either side.
Behaviour behaviour_at(const Instants& instants, std::size_t i, std::size_t window, Side seen_by,
                       const DualQuaternion& T_a_b) {
  const auto pose = [&](std::size_t k) {
    const PosePair poses = instants.at(k);
    return to_pose(seen_by == Side::b ? poses.b : poses.a * T_a_b);
  };
  const Pose from = pose(i - window), here = pose(i), to = pose(i + window);
  const double half = 0.5 * (instants.time(i + window) - instants.time(i - window));
  Behaviour behaviour;
  behaviour << rotation_log(from.rotation.conjugate() * to.rotation) / (2 * half),
      here.rotation.conjugate() * (to.translation - 2 * here.translation + from.translation) / (half * half);
  return behaviour;
}

std::vector<FollowedChange> followed_changes(const Instants& instants, const DualQuaternion& T_a_b,
                                             std::size_t steps, std::size_t window, Side seen_by,
                                             const FollowingOptions& options) {
  std::vector<FollowedChange> changes;
  const std::size_t n = instants.size(), span = steps + 2 * window;
  if (n <= span) return changes;
  const std::size_t each = std::max<std::size_t>(1, (n - span) / options.motions);
  for (std::size_t i = window; i + steps + window < n; i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k + window) - instants.time(i - window) >
        options.across_a_gap * static_cast<double>(span) * instants.period)
      continue;
    const PosePair from = instants.at(i), to = instants.at(k);
    const Pose change =
        to_pose(conjugate(T_a_b) * conjugate(from.a) * to.a * T_a_b * conjugate(conjugate(from.b) * to.b));
    changes.push_back({rotation_log(change.rotation),
                       to_pose(conjugate(from.b) * to.b).rotation.toRotationMatrix(),
                       behaviour_at(instants, i, window, seen_by, T_a_b),
                       behaviour_at(instants, k, window, seen_by, T_a_b)});
  }
  return changes;
}

template <typename Size>
double quantile_of(const std::vector<FollowedChange>& changes, double part, const Size& size) {
  std::vector<double> sizes;
  for (const FollowedChange& change : changes) sizes.push_back(size(change));
  return quantile(sizes, part);
}

BehaviourCourse course_of(const Behaviour& behaviour, const Behaviour& usual,
                          const FollowingOptions& options) {
  BehaviourCourse course;
  for (int i = 0; i < 6; ++i) {
    const double part = behaviour[i] / usual[i];
    course[i] = std::clamp(part, -options.largest, options.largest);
    course[6 + i] = part / std::hypot(part, options.sign);
  }
  return course;
}

/// The change is these times the relation.
FollowedRows followed_rows_of(const FollowedChange& change, const Behaviour& usual,
                              const FollowingOptions& options) {
  const BehaviourCourse before = course_of(change.before, usual, options),
                        after = course_of(change.after, usual, options);
  FollowedRows rows;
  for (int i = 0; i < 12; ++i)
    rows.middleCols<3>(3 * i) = before[i] * Eigen::Matrix3d::Identity() - after[i] * change.turned;
  return rows;
}

std::optional<Following> following_by(const Instants& instants, const DualQuaternion& T_a_b,
                                      std::size_t steps, Side seen_by, const FollowingOptions& options) {
  const auto window =
      std::max<std::size_t>(1, static_cast<std::size_t>(options.window * static_cast<double>(steps)));
  std::vector<FollowedChange> changes = followed_changes(instants, T_a_b, steps, window, seen_by, options);
  const std::size_t n = changes.size();
  if (n < options.least) return std::nullopt;
  Behaviour usual;
  for (int i = 0; i < 6; ++i)
    usual[i] = std::max(1e-9, quantile_of(changes, options.usual, [i](const FollowedChange& change) {
                          return std::abs(change.before[i]);
                        }));
  const double longest = options.longest * quantile_of(changes, 0.5, [](const FollowedChange& change) {
                           return change.rotation.norm();
                         });
  std::vector<FollowedRows> rows;
  for (FollowedChange& change : changes) {
    if (const double length = change.rotation.norm(); length > longest) change.rotation *= longest / length;
    rows.push_back(followed_rows_of(change, usual, options));
  }
  // a clock that differs, in each part by itself
  for (std::size_t part = 0; part < options.parts; ++part) {
    double of_clock = 0, squares = 0;
    const std::size_t begin = part * n / options.parts, end = (part + 1) * n / options.parts;
    for (std::size_t i = begin; i < end; ++i) {
      of_clock += changes[i].by_clock().dot(changes[i].rotation);
      squares += changes[i].by_clock().squaredNorm();
    }
    for (std::size_t i = begin; i < end && squares > 0; ++i)
      changes[i].rotation -= of_clock / squares * changes[i].by_clock();
  }
  double all = 0, left = 0;
  std::vector<double> explained;
  for (const std::size_t half : {0u, 1u}) {
    const auto within = [&](std::size_t i) { return i * options.parts / n % 2 == half; };
    Eigen::Matrix<double, 36, 36> normal = Eigen::Matrix<double, 36, 36>::Zero();
    FollowingRelation product = FollowingRelation::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      if (within(i)) continue;
      add_square(normal, 1, rows[i]);
      add_product(product, 1, rows[i], changes[i].rotation);
    }
    normal.diagonal().array() += options.penalty * normal.trace() / 36;
    const FollowingRelation relation = solve_symmetric(normal, product);
    for (std::size_t i = 0; i < n; ++i) {
      if (!within(i)) continue;
      const Eigen::Vector3d by_relation = rows[i] * relation;
      all += changes[i].rotation.squaredNorm();
      left += (changes[i].rotation - by_relation).squaredNorm();
      explained.push_back(by_relation.norm());
    }
  }
  if (!(all > 0)) return std::nullopt;
  const auto place = static_cast<std::size_t>(0.95 * static_cast<double>(explained.size()));
  return Following{1 - left / all, order_statistic_in_place(explained, place)};
}

}  // namespace

std::optional<Following> following(const Instants& instants, const DualQuaternion& T_a_b, std::size_t steps,
                                   const FollowingOptions& options) {
  const std::optional<Following> by_a = following_by(instants, T_a_b, steps, Side::a, options),
                                 by_b = following_by(instants, T_a_b, steps, Side::b, options);
  if (!by_a || !by_b) return std::nullopt;
  return Following{std::min(by_a->explained, by_b->explained), std::min(by_a->change, by_b->change)};
}

std::optional<Finding> following_mount(const Instants& instants, int stride, const Answered& answered,
                                       const DiagnosisOptions& options) {
  const FollowingOptions tuning;
  std::optional<Following> found;
  for (const int steps : {stride, std::max(2, stride / 2)}) {
    const std::optional<Following> here =
        following(instants, answered.T_a_b, static_cast<std::size_t>(steps), tuning);
    if (here && here->explained >= tuning.explained && here->change >= tuning.least_change &&
        (!found || found->explained < here->explained))
      found = here;
  }
  if (!found) return std::nullopt;
  const double interpolation = std::sqrt(mean_square_by_interpolation(instants, options.undersampling.poses));
  if (found->change < tuning.of_interpolation * interpolation) return std::nullopt;
  Finding finding;
  finding.code = "mount_moved";
  finding.message = format(
      "The motions contradict each other: the rotation between the sensors changes by up to %.2g deg "
      "with how they turn and accelerate, which is %.0f %% of what no mounting explains: a sensor is "
      "on a part that is steered or sprung, or its mounting has play.",
      found->change * degrees_per_radian, 100 * found->explained);
  finding.remedy = "Fasten both sensors to one rigid part, and record again.";
  return finding;
}

}  // namespace egocal::detail
