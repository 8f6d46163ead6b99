// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "linear_algebra/small_factor.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

double rotation_noise(const Matrix8d& Q, const DualQuaternion& q) {
  return std::max(0.0, q.real.dot(Q.bottomRightCorner<4, 4>() * q.real));
}

std::vector<HiddenTurn> hidden_turns(const Surroundings& around, const ObservabilityOptions& options) {
  std::vector<HiddenTurn> turns;
  const auto hidden = around.hidden_vectors();
  const bool rotation_hidden = (hidden.bottomRows<3>().rowwise().norm().array() > options.leak).any();
  if (!rotation_hidden) return turns;
  const Eigen::Matrix3d parts = hidden.bottomRows<3>() * hidden.bottomRows<3>().transpose();
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(parts);
  for (int k = 2; k >= 0; --k) {
    const double part = std::sqrt(std::max(0.0, eigen.values[k]));
    if (!(part > options.hinted_part)) break;
    const Eigen::Vector3d axis = eigen.vectors.col(k);
    const Eigen::Vector3d moment =
        hidden.topRows<3>() * (hidden.bottomRows<3>().transpose() * axis) / (part * part);
    turns.push_back({axis, moment.cross(axis), part});
  }
  return turns;
}

std::array<bool, 6> observable_around(const Surroundings& around, ErrorCorrelation errors,
                                      const ObservabilityOptions& options) {
  std::array<bool, 6> result{};
  for (int i = 0; i < 6; ++i)
    result[static_cast<std::size_t>(i)] = around.hidden_vectors().row(i).norm() <= options.leak;
  if (errors == ErrorCorrelation::independent) return result;
  const std::vector<HiddenTurn> turns = hidden_turns(around, options);
  for (const HiddenTurn& turn : turns)
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double across = std::sqrt(std::max(0.0, 1 - turn.axis[i] * turn.axis[i]));
      const double change = turn.arm.norm() * across;
      result[k] = result[k] && turn.rotation_part * change <= options.leak &&
                  change * around.length <= options.leak * options.unknown_translation;
      // turns about two axes make any rotation
      result[k + 3] = result[k + 3] && turns.size() == 1 && std::abs(turn.axis[i]) <= options.leak;
    }
  return result;
}

Vector6d with_hidden_turns(const std::vector<HiddenTurn>& turns, Vector6d variance, double lengths,
                           bool has_prior, const ObservabilityOptions& options) {
  if (turns.empty()) return variance;
  variance.head<3>().setConstant(variance.head<3>().maxCoeff());
  variance.tail<3>().setConstant((has_prior ? 1 : 2 * std::numbers::ln2) * variance.tail<3>().maxCoeff());
  for (const HiddenTurn& turn : turns) {
    const Eigen::Vector3d arm = lengths * turn.arm, sideways = turn.axis.cross(arm);
    const Eigen::Vector3d axis2 = turn.axis.cwiseAbs2();
    if (has_prior) {  // a small angle, from an arm in any direction across the axis
      const double angle2 = options.prior_rotation * options.prior_rotation;
      variance.head<3>() += angle2 * arm.squaredNorm() * (Eigen::Vector3d::Ones() - axis2);
      variance.tail<3>() += angle2 * axis2;
    } else {  // arm (cos alpha - 1) + sideways sin alpha, and alpha axis
      variance.head<3>() += 1.5 * arm.cwiseAbs2() + 0.5 * sideways.cwiseAbs2();
      variance.tail<3>() += std::numbers::pi * std::numbers::pi / 3 * axis2;
    }
  }
  return variance;
}

Vector6d variance_of_hidden(const Surroundings& around, bool has_prior, const ObservabilityOptions& options) {
  if (around.hidden == 0) return Vector6d::Zero();
  const auto hidden = around.hidden_vectors();
  const DualQuaternion& q = around.q;
  const Eigen::Vector3d t = 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
  // without a prior the value of the answer along it is just as unknown
  const double claimed = (hidden.topRows<3>().transpose() * t).norm();
  const double translation = has_prior ? options.prior_translation / around.length
                                       : std::hypot(options.unknown_translation / around.length, claimed);
  const double rotation = has_prior ? options.prior_rotation : options.unknown_rotation;
  Vector6d precision;
  precision << Eigen::Vector3d::Constant(1 / (translation * translation)),
      Eigen::Vector3d::Constant(1 / (rotation * rotation));
  const SmallFactor confined(hidden.transpose() * precision.asDiagonal() * hidden);
  const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> across =
      confined.solve(SquareUpToSix(hidden.transpose()));
  return (hidden * across).diagonal();
}

Vector6d pull_of_noise(const Surroundings& around, const Eigen::Vector3d& t,
                       const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& seen) {
  Vector6d slope = Vector6d::Zero();
  slope.head<3>() = 0.25 * around.noise * t;
  Matrix6d clean = around.H;
  clean.diagonal().head<3>().array() -= 0.25 * around.noise;
  const SmallFactor curvature(seen.transpose() * clean * seen);
  if (!curvature.positive()) return Vector6d::Zero();
  return seen * curvature.solve(UpToSix(seen.transpose() * slope));
}

Eigen::Vector3d translation_of(const DualQuaternion& q) {
  return 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
}

}  // namespace egocal::detail
