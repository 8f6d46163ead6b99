// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/planar_observability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/plane_directions.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/hint.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/variance.hpp"

namespace egocal {

using namespace detail;

namespace {

std::string hint_in_plane(const Surroundings& around, const ObservabilityOptions& options) {
  bool translation = false, yaw = false;
  for (int k = 0; k < around.hidden; ++k) {
    translation = translation || around.vectors.col(k).head<3>().norm() > options.hinted_part;
    yaw = yaw || around.vectors.col(k).tail<3>().norm() > options.hinted_part;
  }
  return planar_hint(translation, yaw, around.hidden);
}

/// pull_of_noise() in planar mode [m, rad].
Vector6d pull_in_plane(const Problem& problem, const DualQuaternion& T_a_b, const Surroundings& around) {
  const DualQuaternion G_a = plane_frame(problem.plane_a);
  const DualQuaternion T_p = planar_from_extrinsic(T_a_b, G_a, plane_frame(problem.plane_b));
  const Eigen::Vector3d t = to_pose(G_a).rotation * translation_of(T_p) / around.length;
  Vector6d pull = pull_of_noise(around, t, around.vectors.middleCols(around.hidden, 3 - around.hidden));
  pull.head<3>() *= around.length;
  return pull;
}

/// The directions around T_p, whose frame has its origin below sensor a and the axes of a.
ShownDirections shown_in_plane(const Problem& problem, const DualQuaternion& T_a_b,
                               const Surroundings& around) {
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = in_units_of(around.length, planar_from_extrinsic(T_a_b, G_a, G_b));
  const Eigen::Matrix3d axes = to_pose(G_a).rotation.toRotationMatrix();
  const int shown = 3 - around.hidden;
  Matrix6d basis = Matrix6d::Zero(), in_plane = Matrix6d::Zero();
  basis.leftCols(shown) = around.vectors.middleCols(around.hidden, shown);
  in_plane.topRows<3>() = axes.transpose() * basis.topRows<3>();
  in_plane.bottomRows<3>() = axes.transpose() * basis.bottomRows<3>();
  const Matrix86d tangent = frame_a_basis(T_p).lazyProduct(in_plane);
  return {TangentSpace(T_p, around.length, tangent, problem.balance), basis, shown};
}

}  // namespace

Surroundings detail::look_around_in_plane(const Problem& problem, const Matrix8d& Q_metres,
                                          const DualQuaternion& T_a_b, std::uint64_t pairs,
                                          const ObservabilityOptions& options) {
  Surroundings around;
  around.pairs = static_cast<double>(pairs);
  around.length = length_scale(Q_metres);
  around.q = in_units_of(around.length, T_a_b);
  const Matrix8d Q = in_units_of(around.length, Q_metres);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = in_units_of(around.length, planar_from_extrinsic(T_a_b, G_a, G_b));
  // x, y and yaw of T_p, whose frame has its origin below sensor a: turning it moves no translation there
  const Matrix86d all = frame_a_basis(T_p);
  Eigen::Matrix<double, 8, 3> basis;
  basis << all.col(0), all.col(1), all.col(5);
  const double least = cost(Q, T_p);
  const Eigen::Matrix3d H = basis.transpose() * lagrangian_matrix(Q, {least, 0}) * basis;
  Eigen::Matrix3d clean = H;
  around.noise = rotation_noise(Q, T_p);
  const double fluctuation = 4 / std::sqrt(std::max(1.0, around.pairs));
  clean.diagonal().head<2>().array() -= 0.25 * around.noise * (options.independent_noise + fluctuation);
  clean(2, 2) -= 0.25 * fluctuation * std::max(0.0, least);
  const SymmetricEigen<3> seen = symmetric_eigen<3>(clean);
  const double floor = 0.25e-12 * Q.diagonal().sum();
  while (around.hidden < 3 && !(seen.values[around.hidden] > floor)) ++around.hidden;
  const Eigen::Matrix3d axes = to_pose(G_a).rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, 3> in_a = Eigen::Matrix<double, 6, 3>::Zero();
  in_a.topLeftCorner<3, 2>() = axes.leftCols<2>();
  in_a.bottomRightCorner<3, 1>() = axes.col(2);
  around.H = in_a * H * in_a.transpose();
  around.vectors.setZero();
  around.vectors.leftCols<3>() = in_a * seen.vectors;
  return around;
}

std::array<bool, 6> detail::observable_in_plane(const Problem& problem, const Surroundings& around,
                                                ErrorCorrelation errors,
                                                const ObservabilityOptions& options) {
  std::array<bool, 6> result = observable_around(around, errors, options);
  for (std::size_t i = 0; i < 6; ++i) result[i] = result[i] && in_plane(problem.plane_a, i);
  return result;
}

Observability detail::planar_observability(const Problem& problem, const Matrix8d& Q,
                                           const DualQuaternion& T_a_b, ErrorCorrelation errors,
                                           const ObservabilityOptions& options) {
  Observability result;
  result.stddev.fill(std::numeric_limits<double>::infinity());
  const Statistics all = sum_blocks(problem.blocks);
  const Surroundings around = look_around_in_plane(problem, Q, T_a_b, all.count, options);
  result.observable = observable_in_plane(problem, around, errors, options);
  result.hint = hint_in_plane(around, options);
  if (around.hidden == 3 || blocks_to_omit(problem) < options.least_blocks) return result;
  const ShownDirections directions = shown_in_plane(problem, T_a_b, around);
  Vector6d variance = variance_by_blocks(problem, around.pairs, directions, errors, options);
  variance.head<3>() *= around.length * around.length;
  if (errors == ErrorCorrelation::correlated) {
    variance = with_hidden_turns(hidden_turns(around, options), variance, around.length, false, options);
    Vector6d of_hidden = variance_of_hidden(around, false, options);
    of_hidden.head<3>() *= around.length * around.length;
    variance += of_hidden;
  }
  const Vector6d pull = pull_in_plane(problem, T_a_b, around);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!result.observable[k]) continue;
    const double stddev = std::sqrt(variance[i] + pull[i] * pull[i]);
    if (std::isfinite(stddev)) result.stddev[k] = stddev;
  }
  return result;
}

}  // namespace egocal
