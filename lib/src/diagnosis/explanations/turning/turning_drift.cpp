// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/turning_drift.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/motions/at_ends.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Duration of each motion [s].
std::vector<double> durations_of(const Instants& instants, const Motions& motions) {
  std::vector<double> result;
  for (const std::size_t begin : begins_of(instants, motions)) {
    const std::size_t end = begin + static_cast<std::size_t>(motions.stride);
    result.push_back(end < instants.size() ? instants.time(end) - instants.time(begin) : 0);
  }
  return result;
}

/// How fast a turns away from b, in the frame of a [rad/s], and by how many standard deviations.
struct Rate {
  Vector3d of_a = Vector3d::Zero();
  double sigmas = 0;
};

struct Sums {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();

  /// The rate that the sums show; what is not shown stays zero.
  Vector3d rate() const {
    Matrix6d kept = A;
    kept.diagonal().array() += 1e-9 * A.trace() / 6 + 1e-300;
    return solve_symmetric(kept, b).bottomRows<3>();
  }
};

/// The rate beside a turn of the mounting: linear least squares of the rotations.
Rate rate_of(const Explained& explained, const std::vector<double>& durations,
             const TurningDriftOptions& options) {
  const Matrix3d R = to_pose(explained.fit.T).rotation.toRotationMatrix();
  const std::vector<Motion>& all = explained.motions.all;
  std::vector<Vector3d> turned, left;
  std::vector<double> squares;
  for (const Motion& motion : all) {
    turned.push_back(R * rotation_log(to_pose(motion.b).rotation));
    left.push_back(rotation_log(to_pose(motion.a).rotation) - turned.back());
    squares.push_back(left.back().squaredNorm());
  }
  const double typical = median(std::vector<double>(squares)) + 1e-300;
  std::vector<Sums> parts(std::min(options.parts, all.size()));
  Sums sum;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double weight = std::pow(1 + squares[i] / (options.inlier * typical), -2);
    Eigen::Matrix<double, 3, 6> rows;
    rows.leftCols<3>() = -cross_matrix(turned[i]);
    rows.rightCols<3>() = durations[i] * Matrix3d::Identity();
    Sums& part = parts[i * parts.size() / all.size()];
    for (Sums* one : {&part, &sum}) {
      add_square(one->A, weight, rows);
      add_product(one->b, weight, rows, left[i]);
    }
  }
  Rate rate{sum.rate(), 0};
  // by leaving out parts of the drive
  const double m = static_cast<double>(parts.size());
  Vector3d mean = Vector3d::Zero();
  std::vector<Vector3d> without;
  for (const Sums& part : parts) {
    Sums others = sum;
    others.A -= part.A;
    others.b -= part.b;
    without.push_back(others.rate());
    mean += without.back() / m;
  }
  Matrix3d covariance = 1e-24 * Matrix3d::Identity();  // rounding
  for (const Vector3d& one : without) covariance += (m - 1) / m * (one - mean) * (one - mean).transpose();
  const double size = rate.of_a.norm();
  if (!(size > 0)) return rate;
  const Vector3d along = rate.of_a / size;
  rate.sigmas = size / std::sqrt(along.dot(covariance * along));
  return rate;
}

/// The motions of which one stream turned by `rate` less, in its own frame [rad/s]; its positions are those
/// of the file, in the world that its rotations had at the begin of the drive.
Motions without(const Instants& instants, const Motions& given, const std::vector<std::size_t>& begins,
                Side side, const Vector3d& rate) {
  struct End {
    Rotation as_given, right;
  };
  AtEnds<End> ends(begins, static_cast<std::size_t>(given.stride));
  End now{Rotation::Identity(), Rotation::Identity()};
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const PosePair poses = instants.at(i);
    const Rotation rotation = to_pose(side == Side::a ? poses.a : poses.b).rotation;
    if (i == 0) {
      now = {rotation, rotation};
    } else {
      const double seconds = instants.time(i) - instants.time(i - 1);
      const Rotation step = now.as_given.conjugate() * rotation;
      now = {rotation, (now.right * step * rotation_exp(-seconds * rate)).normalized()};
    }
    ends.pass(i, now);
  }
  Motions motions = given;
  for (std::size_t i = 0; i < motions.all.size() && i < ends.ends.size(); ++i) {
    Motion& motion = motions.all[i];
    const End &begin = ends.begins[i], &end = ends.ends[i];
    const Vector3d t = side == Side::a ? motion.t_a : motion.t_b;
    set_turned_motion(motion, side, begin.right.conjugate() * end.right,
                      begin.right.conjugate() * (begin.as_given * t));
  }
  return motions;
}

struct Drifting {
  Side side = Side::b;
  Vector3d rate;  ///< in the frame of the stream [rad/s]
  Explained explained;
  Comparison comparison;
};

Drifting fitted(const Instants& instants, const Explained& given, const std::vector<double>& durations,
                Side side, const Rate& first, const DiagnosisOptions& options,
                const TurningDriftOptions& drift) {
  const std::vector<std::size_t> begins = begins_of(instants, given.motions);
  Drifting result{side, Vector3d::Zero(), given, {}};
  Vector3d of_a = first.of_a;
  for (int round = 0; round < drift.rounds; ++round) {
    const Rotation R = to_pose(result.explained.fit.T).rotation;
    result.rate += side == Side::a ? of_a : Vector3d(-(R.conjugate() * of_a));
    result.explained.motions = without(instants, given.motions, begins, side, result.rate);
    result.explained.fit = robust_fit(result.explained.motions, options.fit);
    if (round + 1 < drift.rounds) of_a = rate_of(result.explained, durations, drift).of_a;
  }
  result.comparison = compare(given, result.explained);
  return result;
}

Finding worded(const Drifting& drifting) {
  const char which = drifting.side == Side::a ? 'a' : 'b';
  Finding finding =
      finding_of(std::string("turning_drift_") + which, drifting.explained, drifting.comparison, true);
  finding.value = drifting.rate.norm();
  say(finding,
      format(
          "The rotations of %s turn away from its positions by %.2g deg each second: the squared residuals "
          "are %.3g times smaller without that.",
          mark(which), *finding.value * degrees_per_radian, finding.improvement),
      format("Take off the bias of the gyroscope of %s, or take its rotations and its positions from one "
             "source.",
             mark(which)));
  return finding;
}

}  // namespace

std::vector<Finding> turning_drift(const Instants& instants, const Explained& given,
                                   const DiagnosisOptions& options, const TurningDriftOptions& drift) {
  if (instants.size() < 3 || given.motions.all.size() < std::max(options.motions.least, 2 * drift.parts))
    return {};
  const std::vector<double> durations = durations_of(instants, given.motions);
  const double seconds = instants.time(instants.size() - 1) - instants.time(0);
  const Rate rate = rate_of(given, durations, drift);
  if (!(rate.sigmas >= drift.sigmas) || !(rate.of_a.norm() <= drift.most_rate) ||
      !(rate.of_a.norm() * seconds >= drift.least * options.tolerance_rotation))
    return {};
  std::vector<Drifting> best;
  for (const Side side : {Side::b, Side::a}) {
    Drifting here = fitted(instants, given, durations, side, rate, options, drift);
    if (explains(here.explained, options) && better(here.comparison, options.gain, options))
      best.push_back(std::move(here));
  }
  std::stable_sort(best.begin(), best.end(), [](const Drifting& x, const Drifting& y) {
    return x.comparison.gain > y.comparison.gain;
  });
  std::vector<Finding> findings;
  for (const Drifting& drifting : best) {
    if (better(compare(drifting.explained, best.front().explained), options.gain, options)) break;
    findings.push_back(worded(drifting));
  }
  return findings;
}

}  // namespace egocal::detail
