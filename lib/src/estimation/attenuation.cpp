// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/attenuation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

using detail::Vector6d;

/// Least part of the noise that is left along the rotation: far above rounding.
constexpr double least_left = 1e-6;

/// The eigenvectors of D orthogonal to r (columns of `across`, ascending), and the part of each eigenvalue
/// that is noise.
struct NoiseCurvatures {
  DualQuaternion q;
  double noise = 0;      ///< r'Dr
  double cost = 0;       ///< q'Qq
  double dual_gain = 0;  ///< |Br|^2
  Eigen::Matrix<double, 4, 3> across;
  Eigen::Vector3d curvature;
  Eigen::Vector3d coupling;  ///< of the eigenvectors with r, by D
  Eigen::Vector3d length;    ///< components of d
  Eigen::Matrix3d ways;      ///< columns: where t goes along each, in sensor a's frame; t = 2 d r*

  double part(int i) const { return noise / curvature[i]; }
  /// What the noise takes off |t| along an eigenvector.
  double pull(int i) const { return 2 * std::abs(length[i]) * part(i) / (1 - part(i)); }
};

std::optional<NoiseCurvatures> curvatures(const Problem& problem) {
  const Matrix8d Q = cost_matrix(problem);
  const Solution solution = solve_dual(Q);
  if (solution.status != SolverStatus::converged) return std::nullopt;
  NoiseCurvatures result;
  result.q = solution.q;
  const Eigen::Vector4d r = solution.q.real, d = solution.q.dual;
  const Eigen::Matrix4d D = Q.bottomRightCorner<4, 4>();
  result.noise = r.dot(D * r);
  result.cost = cost(Q, solution.q);
  result.dual_gain = (Q.topRightCorner<4, 4>() * r).squaredNorm();
  // r i, r j, r k span what is across r
  Eigen::Matrix<double, 4, 3> basis;
  for (int i = 0; i < 3; ++i) basis.col(i) = quaternion_product(Eigen::Vector4d::Unit(i + 1), r);
  const detail::SymmetricEigen<3> eigen = detail::symmetric_eigen<3>(basis.transpose() * D * basis);
  result.across = basis * eigen.vectors;
  result.curvature = eigen.values;
  if (!(result.noise > 0) || !(result.curvature[0] > 0)) return std::nullopt;
  result.coupling = result.across.transpose() * (D * r);
  result.length = result.across.transpose() * d;
  result.ways = eigen.vectors;  // as the basis is the unit vectors times r
  return result;
}

/// How much of the noise must be left along r, as a part of it. With `needed` D stays positive semidefinite.
/// A dual part along r, which only rotations far from r have, must not pay for them: its gain |Br|^2 / noise
/// must be a part of the least cost.
double left_along_rotation(const NoiseCurvatures& all, double reserve) {
  double needed = all.dual_gain / (all.noise * all.cost);
  for (int i = 0; i < 3; ++i)
    needed += all.coupling[i] * all.coupling[i] / ((all.curvature[i] - all.noise) * all.noise);
  return std::isfinite(needed) ? std::clamp(reserve * needed, least_left, 1.0) : 1.0;
}

bool positive_definite(const Matrix8d& Q) {
  const Eigen::LLT<Matrix8d> factors(Q);
  return factors.info() == Eigen::Success;
}

/// Empty: whatever noise is left along the rotation, Q is not positive definite.
std::optional<Attenuation> taking_off(const Problem& problem, const NoiseCurvatures& all,
                                      const std::array<bool, 3>& corrected,
                                      const AttenuationOptions& options) {
  Attenuation result;
  result.r = all.q.real;
  Eigen::Matrix4d across = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 3; ++i)
    if (corrected[static_cast<std::size_t>(i)]) across += all.across.col(i) * all.across.col(i).transpose();
  // the noise that is left appears along r: all of it if a direction keeps its own
  const Eigen::Matrix4d along = result.r * result.r.transpose();
  const bool everywhere = std::all_of(corrected.begin(), corrected.end(), [](bool one) { return one; });
  double left = everywhere ? left_along_rotation(all, options.reserve) : 1;
  while (true) {
    result.taken_off = across + (1 - left) * along;
    if (without_attenuation(problem, result)) return result;
    if (!(left < 1)) return std::nullopt;
    left = std::min(1.0, options.reserve * left);
  }
}

/// Standard deviations by leaving out blocks, in the frame of sensor a with the translation along the columns
/// of `ways`.
Vector6d standard_deviations(const Problem& problem, const DualQuaternion& T_a_b,
                             const Eigen::Matrix3d& ways) {
  std::vector<Vector6d> differences = leave_out_differences(problem, cost_matrix(problem), T_a_b);
  const auto blocks = static_cast<double>(differences.size());
  Vector6d mean = Vector6d::Zero(), squares = Vector6d::Zero();
  for (Vector6d& difference : differences) {
    difference.head<3>() = (ways.transpose() * difference.head<3>()).eval();
    mean += difference / blocks;
  }
  for (const Vector6d& difference : differences) squares += (difference - mean).cwiseAbs2();
  return (squares * (blocks - 1) / blocks).cwiseSqrt();
}

/// x and y lose the noise, and so does what is seen of it: as much as leaves Q positive definite.
std::optional<Problem> taking_off_in_plane(const Problem& problem, const AttenuationOptions& options,
                                           Attenuation& attenuation) {
  const Eigen::Vector4d translations(0, 1, 1, 0), rotations(1, 0, 0, 1);
  double left = least_left;
  while (true) {
    attenuation.taken_off = (translations + (1 - left) * rotations).asDiagonal();
    std::optional<Problem> result = without_attenuation(problem, attenuation);
    if (result || !(left < 1)) return result;
    left = std::min(1.0, options.reserve * left);
  }
}

std::optional<Attenuation> find_attenuation_in_plane(const Problem& problem,
                                                     const AttenuationOptions& options) {
  const Matrix8d Q = cost_matrix(problem);
  const DualQuaternion T_p = solve_planar(Q).q;
  const DualQuaternion before = detail::extrinsic_of(problem, T_p);
  // what is mostly noise stays what it is, and hidden
  if (hidden_directions(problem, Q, before).basis.cols() > 0) return std::nullopt;
  Attenuation result;
  result.r = T_p.real;
  const std::optional<Problem> corrected = taking_off_in_plane(problem, options, result);
  if (!corrected) return std::nullopt;
  const DualQuaternion after = detail::extrinsic_of(*corrected, solve_planar(cost_matrix(*corrected)).q);
  const Vector6d pull = detail::frame_a_difference(before, after);
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const Vector6d stddev = standard_deviations(problem, before, axes);
  const double translation = stddev.head<3>().norm(), rotation = stddev.tail<3>().norm();
  result.pull = std::max(pull.head<3>().norm() / translation, pull.tail<3>().norm() / rotation);
  if (!(result.pull > options.least_pull) || !std::isfinite(result.pull)) return std::nullopt;
  if (!(pull.tail<3>().norm() < options.most_turn)) return std::nullopt;
  const Vector6d wider = standard_deviations(*corrected, after, axes);
  if (!(wider.head<3>().norm() < options.most_loss * translation) ||
      !(wider.tail<3>().norm() < options.most_loss * rotation))
    return std::nullopt;
  return result;
}

/// Where translations are seen together with the rotation alone (circles of nearly one radius), both are
/// pulled by far more than along one eigenvector of D. Empty where the answer changes by less than least_pull
/// standard deviations, or what is known becomes too uncertain.
std::optional<Attenuation> pays_together(const Problem& problem, const DualQuaternion& q,
                                         Attenuation attenuation, const AttenuationOptions& options) {
  const std::optional<Problem> corrected = without_attenuation(problem, attenuation);
  if (!corrected) return std::nullopt;
  const Matrix8d Q = cost_matrix(*corrected);
  const Solution without = solve_dual(Q);
  if (without.status != SolverStatus::converged) return std::nullopt;
  const Vector6d pull = detail::frame_a_difference(q, without.q).cwiseAbs();
  if (!(pull.tail<3>().norm() < options.most_turn)) return std::nullopt;
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const Vector6d stddev = standard_deviations(problem, q, axes);
  const auto seen = observable_directions(problem, cost_matrix(problem), q, ErrorCorrelation::correlated);
  attenuation.pull = 0;
  for (int i = 0; i < 6; ++i)
    if (seen[static_cast<std::size_t>(i)] && stddev[i] > 0)
      attenuation.pull = std::max(attenuation.pull, pull[i] / stddev[i]);
  if (!(attenuation.pull > options.least_pull) || !std::isfinite(attenuation.pull)) return std::nullopt;
  const auto still_seen = observable_directions(*corrected, Q, without.q, ErrorCorrelation::correlated);
  const Vector6d wider = standard_deviations(*corrected, without.q, axes);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (seen[k] && !(still_seen[k] && wider[i] < options.most_loss * stddev[i])) return std::nullopt;
  }
  return attenuation;
}

}  // namespace

std::optional<Attenuation> find_attenuation(const Problem& problem, const AttenuationOptions& options) {
  if (problem.blocks.size() < options.least_blocks) return std::nullopt;
  if (problem.mode == Mode::planar) return find_attenuation_in_plane(problem, options);
  const std::optional<NoiseCurvatures> all = curvatures(problem);
  if (!all) return std::nullopt;
  const Eigen::Vector3d stddev = standard_deviations(problem, all->q, all->ways).head<3>();
  if (!stddev.allFinite()) return std::nullopt;
  std::array<bool, 3> may_be{}, shown{};
  bool needed = false;
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double part = all->part(i);
    shown[k] = part < options.most_noise && (part * options.shown_curvature < 1 ||
                                             2 * std::abs(all->length[i]) > options.shown_sigmas * stddev[i]);
    if (!shown[k]) continue;
    // the correction makes the standard deviation 1 / (1 - part) times as large
    const double loss = std::sqrt(1 / ((1 - part) * (1 - part)) - 1);
    const double pull = all->pull(i) / stddev[i];
    const bool pays = pull > std::max(options.least_pull, loss);
    needed = needed || pays;
    may_be[k] = pays || loss < options.least_pull;
    if (pays) largest = std::max(largest, pull);
  }
  if (std::none_of(may_be.begin(), may_be.end(), [](bool one) { return one; })) return std::nullopt;
  std::optional<Attenuation> result = taking_off(problem, *all, may_be, options);
  if (result && !needed) return pays_together(problem, all->q, *result, options);
  if (result) result->pull = largest;
  return result;
}

std::optional<Attenuation> whole_attenuation(const Problem& problem, const AttenuationOptions& options) {
  if (problem.mode == Mode::planar) return std::nullopt;
  const std::optional<NoiseCurvatures> all = curvatures(problem);
  if (!all) return std::nullopt;
  std::array<bool, 3> corrected{};
  for (int i = 0; i < 3; ++i) corrected[static_cast<std::size_t>(i)] = all->part(i) < options.most_noise;
  if (std::none_of(corrected.begin(), corrected.end(), [](bool one) { return one; })) return std::nullopt;
  return taking_off(problem, *all, corrected, options);
}

std::optional<Problem> without_attenuation(const Problem& problem, const Attenuation& attenuation) {
  Problem result = problem;
  result.balance = {0, 1};
  const Eigen::Vector4d r = attenuation.r;
  const Eigen::Matrix4d taken_off = attenuation.taken_off;
  for (Statistics& block : result.blocks) {
    Matrix8d& S = block.dual_rows;
    const Eigen::Matrix4d D = S.bottomRightCorner<4, 4>();
    S *= problem.balance.translation;
    S.topLeftCorner<4, 4>() += problem.balance.rotation * D;
    S.bottomRightCorner<4, 4>() -= problem.balance.translation * r.dot(D * r) * taken_off;
  }
  if (!positive_definite(cost_matrix(result))) return std::nullopt;
  return result;
}

}  // namespace egocal
