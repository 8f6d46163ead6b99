// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/turned_lever_arm.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/common_mistakes.hpp"
#include "diagnosis/stillest_point.hpp"
#include "diagnosis/wording.hpp"
#include "linear_algebra/cross_matrix.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// What a lever arm of one metre along each axis, turned by the inverse rotations, adds to the translation of
/// each motion, in the frame of its begin: R_0'(R_1' - R_0').
struct ByLeverArm {
  std::vector<Matrix3d> a, b;
};

/// Of the motions that motions_of() makes of the same instants, by their times.
ByLeverArm by_lever_arm(const Instants& instants, const Motions& motions) {
  const auto span = static_cast<std::size_t>(motions.stride);
  ByLeverArm result;
  std::size_t i = 0;
  for (const Motion& motion : motions.all) {
    while (i + span + 1 < instants.size() &&
           0.5 * (instants.time(i) + instants.time(i + span)) < motion.time - 1e-9)
      ++i;
    const PosePair begin = instants.at(i), end = instants.at(i + span);
    const auto added = [](const DualQuaternion& from, const DualQuaternion& to) {
      const Matrix3d back = rotation_of(from).transpose();
      return Matrix3d(back * (rotation_of(to).transpose() - back));
    };
    result.a.push_back(added(begin.a, end.a));
    result.b.push_back(added(begin.b, end.b));
  }
  return result;
}

/// The motions without a lever arm in one stream.
Motions without(const Motions& given, const ByLeverArm& added, Side side, const Vector3d& lever) {
  Motions motions = given;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    Motion& motion = motions.all[i];
    Vector3d& t = side == Side::a ? motion.t_a : motion.t_b;
    t -= (side == Side::a ? added.a : added.b)[i] * lever;
    DualQuaternion& pose = side == Side::a ? motion.a : motion.b;
    pose = canonical_sign(to_dual_quaternion(Pose{to_pose(pose).rotation, t}));
  }
  return motions;
}

/// The lever arm that suits the translations best, beside a change of the extrinsic: linear least squares.
Vector3d best_lever_arm(const Explained& given, const ByLeverArm& added, Side side) {
  const Pose T = to_pose(given.fit.T);
  const Matrix3d R = T.rotation.toRotationMatrix();
  Matrix9d sum = Matrix9d::Zero();
  Vector9d right = Vector9d::Zero();
  for (std::size_t i = 0; i < given.motions.all.size(); ++i) {
    const Motion& motion = given.motions.all[i];
    const Vector3d there = R * motion.t_b;
    const Vector3d residual = motion.R_a * T.translation + motion.t_a - there - T.translation;
    Eigen::Matrix<double, 3, 9> rows;
    rows.leftCols<3>() = motion.R_a - Matrix3d::Identity();
    rows.middleCols<3>(3) = cross_matrix(there);
    rows.rightCols<3>() = side == Side::a ? Matrix3d(-added.a[i]) : Matrix3d(R * added.b[i]);
    sum += given.fit.weights[i] * rows.transpose() * rows;
    right -= given.fit.weights[i] * rows.transpose() * residual;
  }
  sum.diagonal().array() += 1e-9 * sum.trace() / 9 + 1e-300;  // what the drive does not show stays as it is
  return sum.ldlt().solve(right).tail<3>();
}

struct Lever {
  Side side = Side::b;
  Vector3d arm = Vector3d::Zero();
  Explained explained;
  Comparison comparison;
};

Lever fitted(const Explained& given, const ByLeverArm& added, Side side, const DiagnosisOptions& options) {
  Lever lever{side, Vector3d::Zero(), given, {}};
  for (int round = 0; round < options.fit.rounds; ++round) {
    lever.arm += best_lever_arm(lever.explained, added, side);
    lever.explained.motions = without(given.motions, added, side, lever.arm);
    lever.explained.fit = robust_fit(lever.explained.motions, options.fit);
  }
  lever.comparison = compare(given, lever.explained);
  return lever;
}

}  // namespace

std::optional<Finding> turned_lever_arm(const Instants& instants, const Explained& given,
                                        const DiagnosisOptions& options, const TurnedLeverArmOptions& lever) {
  if (given.motions.all.size() < options.motions.least) return std::nullopt;
  const ByLeverArm added = by_lever_arm(instants, given.motions);
  std::optional<Lever> best;
  for (const Side side : {Side::b, Side::a}) {
    Lever here = fitted(given, added, side, options);
    if (!here.arm.allFinite() || here.arm.norm() < lever.least || !explains(here.explained, options) ||
        !better(here.comparison, options.gain, options))
      continue;
    if (!best || here.comparison.gain > best->comparison.gain) best = std::move(here);
  }
  if (!best) return std::nullopt;
  const char which = best->side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("axes_") + which;
  finding.certain = true;
  finding.improvement = std::exp(best->comparison.gain);
  finding.T_a_b = to_pose(best->explained.fit.T);
  finding.message = format(
      "The positions of %c hold a lever arm (%.2f %.2f %.2f m) that was turned by the inverse rotations: the "
      "squared residuals are %.3g times smaller without it.",
      which, best->arm.x(), best->arm.y(), best->arm.z(), finding.improvement);
  finding.remedy = format("Move the positions of %c by p + R l, with R from the body to the world.", which);
  return finding;
}

}  // namespace egocal::detail
