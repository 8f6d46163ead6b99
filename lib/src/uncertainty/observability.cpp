// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/uncertainty/observability.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/hint.hpp"
#include "uncertainty/variance.hpp"

namespace egocal {

namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Spectrum {
  Matrix6d vectors = Matrix6d::Identity();  ///< columns; dt in units of length, dtheta [rad]
  Vector6d curvatures = Vector6d::Zero();   ///< ascending
};

Spectrum spectrum(const Matrix6d& H) {
  const detail::SymmetricEigen<6> eigen = detail::symmetric_eigen<6>(H);
  return {eigen.vectors, eigen.values};
}

/// Whether all curvatures are larger than that.
bool exceeds(Matrix6d H, double curvature) {
  H.diagonal().array() -= curvature;
  return detail::factorise(H);
}

/// Rotation noise, as it enters D: without noise r'Dr is zero; with noise, independent of sensor and motion,
/// it is added to D in every direction alike.
double rotation_noise(const Matrix8d& Q, const DualQuaternion& q) {
  return std::max(0.0, q.real.dot(Q.bottomRightCorner<4, 4>() * q.real));
}

/// Whether the translation along a direction (dt in units of length, dtheta) differs from zero by more than
/// chance: rotation noise that the sensors share pulls it there where no motion shows it.
bool shown_by_translations(const Vector6d& direction, const Problem& problem, const Matrix8d& Q_metres,
                           const DualQuaternion& T_a_b, double length, double sigmas) {
  const std::vector<Vector6d> differences = leave_out_differences(problem, Q_metres, T_a_b);
  const auto blocks = static_cast<double>(differences.size());
  double mean = 0, squares = 0;
  const auto along = [&](Vector6d difference) {
    difference.head<3>() /= length;
    return direction.dot(difference);
  };
  for (const Vector6d& difference : differences) mean += along(difference) / blocks;
  for (const Vector6d& difference : differences) squares += std::pow(along(difference) - mean, 2);
  const double stddev = std::sqrt(squares * (blocks - 1) / blocks);
  return std::abs(direction.head<3>().dot(to_pose(T_a_b).translation)) / length > sigmas * stddev;
}

/// What the curvature of the cost shows around the minimiser; lengths in units of `length` [m].
struct Surroundings {
  double length = 1, pairs = 0;
  DualQuaternion q;
  Matrix86d tangent;                        ///< frame_a_basis() of q
  Matrix6d H;                               ///< reduced Hessian
  double noise = 0;                         ///< rotation_noise()
  Matrix6d vectors = Matrix6d::Identity();  ///< columns: directions, `hidden` ones that are not seen first
  int hidden = 0;

  auto hidden_vectors() const { return vectors.leftCols(hidden); }
};

Surroundings look_around(const Problem& problem, const Matrix8d& Q_metres, const DualQuaternion& T_a_b,
                         ErrorCorrelation errors, const ObservabilityOptions& options) {
  Surroundings around;
  for (const Statistics& block : problem.blocks) around.pairs += static_cast<double>(block.count);
  around.length = detail::length_scale(Q_metres);
  const Matrix8d Q = detail::in_units_of(around.length, Q_metres);
  around.q = detail::in_units_of(around.length, T_a_b);
  around.tangent = detail::frame_a_basis(around.q);
  around.H = around.tangent.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, around.q)) *
             around.tangent;

  // What is left of the curvature when noise is taken off: in the translations `independent_noise` times what
  // rotation noise adds to D (a quarter, as d = t r / 2), in the rotations the fluctuation of J, whose mean
  // lambda_1 takes off already.
  around.noise = rotation_noise(Q, around.q);
  const double fluctuation = 4 / std::sqrt(std::max(1.0, around.pairs));
  Matrix6d clean = around.H;
  clean.diagonal().head<3>().array() -= 0.25 * around.noise * (options.independent_noise + fluctuation);
  clean.diagonal().tail<3>().array() -= 0.25 * fluctuation * std::max(0.0, cost(Q, around.q));
  const double floor = 1e-12 * (around.H.diagonal().cwiseAbs().sum() + Q.diagonal().maxCoeff() * 1e-3);
  const bool may_share =
      errors == ErrorCorrelation::correlated && problem.blocks.size() >= options.least_blocks;
  const double doubtful =
      floor + (may_share ? 0.25 * around.noise * (options.shared_noise - options.independent_noise) : 0);
  // mostly all directions are seen beyond doubt, which a factorisation shows at a tenth of the cost
  if (exceeds(clean, doubtful)) return around;
  const Spectrum seen = spectrum(clean);
  int hidden = 0;
  while (hidden < 6 && !(seen.curvatures[hidden] > floor)) ++hidden;
  if (may_share)
    while (hidden < 6 && seen.curvatures[hidden] < doubtful &&
           seen.vectors.col(hidden).head<3>().norm() > options.least_translation_part &&
           !shown_by_translations(seen.vectors.col(hidden), problem, Q_metres, T_a_b, around.length,
                                  options.shown_sigmas))
      ++hidden;
  around.vectors = seen.vectors;
  around.hidden = hidden;
  return around;
}

/// A rotation of the answer about a line that the motions do not show, in sensor a's frame; lengths in units
/// of `length`.
struct HiddenTurn {
  Eigen::Vector3d axis;  ///< unit vector
  Eigen::Vector3d arm;   ///< from the line to the origin of sensor b, across the axis
  double rotation_part;  ///< of the unit hidden direction
};

/// Those among the hidden directions that differ from hidden translations by more than noise mixes into them.
/// None where all rotations are seen.
std::vector<HiddenTurn> hidden_turns(const Surroundings& around, const ObservabilityOptions& options) {
  std::vector<HiddenTurn> turns;
  const auto hidden = around.hidden_vectors();
  const bool rotation_hidden = (hidden.bottomRows<3>().rowwise().norm().array() > options.leak).any();
  if (!rotation_hidden) return turns;
  const Eigen::Matrix3d parts = hidden.bottomRows<3>() * hidden.bottomRows<3>().transpose();
  const detail::SymmetricEigen<3> eigen = detail::symmetric_eigen<3>(parts);
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

/// A turn that is hidden may be wrong by any angle, so a coordinate must hardly change anywhere along it. The
/// tangent at the minimiser does not tell: where the arm points along x, it is along y alone.
/// Settings of one drive are compared without this test, since they have the same unknown part.
std::array<bool, 6> observable(const Surroundings& around, ErrorCorrelation errors,
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

/// Variances of the coordinates where the answer is somewhere along hidden turns. `variance`: of the
/// directions that are seen, around the minimiser. A turn takes their errors to other coordinates across the
/// axis. Without a prior no angle is more likely than others: then a rotation vector, seen from an answer
/// that is off by the angle alpha, is (alpha / 2) / sin(alpha / 2) as large, whose square is 2 ln 2 in the
/// mean. lengths: of a unit of the turns in that of the variance.
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

/// What errors along the hidden directions add to the variances of the coordinates that they lean into: the
/// covariance of such errors, independent in each coordinate, when they are confined to these directions.
Vector6d variance_of_hidden(const Surroundings& around, bool has_prior, const ObservabilityOptions& options) {
  if (around.hidden == 0) return Vector6d::Zero();
  const auto hidden = around.hidden_vectors();
  const DualQuaternion& q = around.q;
  const Eigen::Vector3d t = 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
  // without a prior, what the answer claims there is as little known
  const double claimed = (hidden.topRows<3>().transpose() * t).norm();
  const double translation = has_prior ? options.prior_translation / around.length
                                       : std::hypot(options.unknown_translation / around.length, claimed);
  const double rotation = has_prior ? options.prior_rotation : options.unknown_rotation;
  Vector6d precision;
  precision << Eigen::Vector3d::Constant(1 / (translation * translation)),
      Eigen::Vector3d::Constant(1 / (rotation * rotation));
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> confined =
      hidden.transpose() * precision.asDiagonal() * hidden;
  return (hidden * confined.ldlt().solve(hidden.transpose())).diagonal();
}

std::string hint(const Surroundings& around, const ObservabilityOptions& options) {
  int hidden_translations = 0;
  bool rotation_hidden = false;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (int k = 0; k < around.hidden; ++k) {
    const Vector6d v = around.vectors.col(k);
    if (v.head<3>().norm() > options.hinted_part) {
      ++hidden_translations;
      direction = v.head<3>().normalized();
    }
    if (v.tail<3>().norm() > options.hinted_part) rotation_hidden = true;
  }
  return detail::spatial_hint(hidden_translations, rotation_hidden, direction);
}

/// Rotation noise pulls the translation towards where it costs least, by the part of D that is noise, and the
/// rotation with it where both are seen together. t: of the minimiser, in sensor a's axes and units of
/// length; seen: columns, the directions that are seen.
Vector6d pull_of_noise(const Surroundings& around, const Eigen::Vector3d& t,
                       const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& seen) {
  Vector6d slope = Vector6d::Zero();
  slope.head<3>() = 0.25 * around.noise * t;
  Matrix6d clean = around.H;
  clean.diagonal().head<3>().array() -= 0.25 * around.noise;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> curvature =
      seen.transpose() * clean * seen;
  const auto factor = curvature.ldlt();
  if (factor.info() != Eigen::Success || !factor.isPositive()) return Vector6d::Zero();
  return seen * factor.solve(seen.transpose() * slope);
}

Eigen::Vector3d translation_of(const DualQuaternion& q) {
  return 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
}

Observability spatial_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                    ErrorCorrelation errors, const ObservabilityOptions& options) {
  const Surroundings around = look_around(problem, Q, T_a_b, errors, options);
  Observability result;
  result.stddev.fill(infinity);
  result.observable = observable(around, errors, options);
  result.hint = hint(around, options);
  if (around.hidden == 6 || problem.blocks.size() < options.least_blocks) return result;

  const bool all = around.hidden == 0;
  const Matrix6d basis = all ? Matrix6d::Identity() : Matrix6d(around.vectors.rowwise().reverse());
  const Matrix86d tangent = all ? around.tangent : Matrix86d(around.tangent.lazyProduct(basis));
  const detail::ShownDirections directions{
      detail::TangentSpace(around.q, around.length, tangent, problem.balance), basis, 6 - around.hidden};
  Vector6d variance = detail::variance_by_blocks(problem, around.pairs, directions, errors, options);
  // settings of one drive have the same unknown part
  if (errors == ErrorCorrelation::correlated) {
    const bool has_prior = problem.prior.has_value();
    variance = with_hidden_turns(hidden_turns(around, options), variance, 1, has_prior, options);
    variance += variance_of_hidden(around, has_prior, options);
  }
  const Vector6d pull = pull_of_noise(around, translation_of(around.q), basis.leftCols(6 - around.hidden));
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!result.observable[k]) continue;
    const double stddev = std::sqrt(variance[i] + pull[i] * pull[i]) * (i < 3 ? around.length : 1);
    if (std::isfinite(stddev)) result.stddev[k] = stddev;
  }
  return result;
}

/// The same in the plane; the hidden directions come first, seen in sensor a's frame. pairs: in all blocks.
Surroundings look_around_in_plane(const Problem& problem, const Matrix8d& Q_metres,
                                  const DualQuaternion& T_a_b, std::uint64_t pairs,
                                  const ObservabilityOptions& options) {
  Surroundings around;
  around.pairs = static_cast<double>(pairs);
  around.length = detail::length_scale(Q_metres);
  around.q = detail::in_units_of(around.length, T_a_b);
  const Matrix8d Q = detail::in_units_of(around.length, Q_metres);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = detail::in_units_of(around.length, planar_from_extrinsic(T_a_b, G_a, G_b));
  // x, y and yaw of T_p, whose frame has its origin below sensor a: turning it moves no translation there
  const Matrix86d all = detail::frame_a_basis(T_p);
  Eigen::Matrix<double, 8, 3> basis;
  basis << all.col(0), all.col(1), all.col(5);
  const double least = cost(Q, T_p);
  const Eigen::Matrix3d H = basis.transpose() * lagrangian_matrix(Q, {least, 0}) * basis;
  Eigen::Matrix3d clean = H;
  around.noise = rotation_noise(Q, T_p);
  const double fluctuation = 4 / std::sqrt(std::max(1.0, around.pairs));
  clean.diagonal().head<2>().array() -= 0.25 * around.noise * (options.independent_noise + fluctuation);
  clean(2, 2) -= 0.25 * fluctuation * std::max(0.0, least);
  const detail::SymmetricEigen<3> seen = detail::symmetric_eigen<3>(clean);
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

/// A coordinate of sensor a's frame must also be one of the plane: x and y lie in it, yaw turns about its
/// normal.
std::array<bool, 6> observable_in_plane(const Problem& problem, const Surroundings& around,
                                        ErrorCorrelation errors, const ObservabilityOptions& options) {
  std::array<bool, 6> result = observable(around, errors, options);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double along = std::abs(problem.plane_a.normal[i]);
    result[k] = result[k] && along <= options.leak;
    result[k + 3] = result[k + 3] && 1 - along <= options.leak;
  }
  return result;
}

std::string planar_hint(const Surroundings& around, const ObservabilityOptions& options) {
  bool translation = false, yaw = false;
  for (int k = 0; k < around.hidden; ++k) {
    translation = translation || around.vectors.col(k).head<3>().norm() > options.hinted_part;
    yaw = yaw || around.vectors.col(k).tail<3>().norm() > options.hinted_part;
  }
  return detail::planar_hint(translation, yaw, around.hidden);
}

/// The same in the plane [m, rad].
Vector6d pull_in_plane(const Problem& problem, const DualQuaternion& T_a_b, const Surroundings& around) {
  const DualQuaternion G_a = plane_frame(problem.plane_a);
  const DualQuaternion T_p = planar_from_extrinsic(T_a_b, G_a, plane_frame(problem.plane_b));
  const Eigen::Vector3d t = to_pose(G_a).rotation * translation_of(T_p) / around.length;
  Vector6d pull = pull_of_noise(around, t, around.vectors.middleCols(around.hidden, 3 - around.hidden));
  pull.head<3>() *= around.length;
  return pull;
}

/// Around T_p, whose frame has its origin below sensor a: the axes are a's.
detail::ShownDirections shown_in_plane(const Problem& problem, const DualQuaternion& T_a_b,
                                       const Surroundings& around) {
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = detail::in_units_of(around.length, planar_from_extrinsic(T_a_b, G_a, G_b));
  const Eigen::Matrix3d axes = to_pose(G_a).rotation.toRotationMatrix();
  const int shown = 3 - around.hidden;
  Matrix6d basis = Matrix6d::Zero(), in_plane = Matrix6d::Zero();
  basis.leftCols(shown) = around.vectors.middleCols(around.hidden, shown);
  in_plane.topRows<3>() = axes.transpose() * basis.topRows<3>();
  in_plane.bottomRows<3>() = axes.transpose() * basis.bottomRows<3>();
  const Matrix86d tangent = detail::frame_a_basis(T_p).lazyProduct(in_plane);
  return {detail::TangentSpace(T_p, around.length, tangent, problem.balance), basis, shown};
}

Observability planar_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options) {
  Observability result;
  result.stddev.fill(infinity);
  const Statistics all = sum_blocks(problem.blocks);
  const Surroundings around = look_around_in_plane(problem, Q, T_a_b, all.count, options);
  result.observable = observable_in_plane(problem, around, errors, options);
  result.hint = planar_hint(around, options);
  if (around.hidden == 3 || problem.blocks.size() < options.least_blocks) return result;
  const detail::ShownDirections directions = shown_in_plane(problem, T_a_b, around);
  Vector6d variance = detail::variance_by_blocks(problem, around.pairs, directions, errors, options);
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

/// Whether there is a cost matrix of motions at all.
bool shows_anything(const Matrix8d& Q) {
  return Q.allFinite() && Q.diagonal().maxCoeff() > 0;
}

}  // namespace

Observability assess_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options) {
  if (!shows_anything(Q)) {
    Observability nothing;
    nothing.stddev.fill(infinity);
    nothing.hint = "still needed: motion";
    return nothing;
  }
  return problem.mode == Mode::planar ? planar_observability(problem, Q, T_a_b, errors, options)
                                      : spatial_observability(problem, Q, T_a_b, errors, options);
}

std::array<bool, 6> observable_directions(const Problem& problem, const Matrix8d& Q,
                                          const DualQuaternion& T_a_b, ErrorCorrelation errors,
                                          const ObservabilityOptions& options) {
  if (!shows_anything(Q)) return {};
  if (problem.mode == Mode::spatial)
    return observable(look_around(problem, Q, T_a_b, errors, options), errors, options);
  const std::uint64_t pairs = sum_blocks(problem.blocks).count;
  return observable_in_plane(problem, look_around_in_plane(problem, Q, T_a_b, pairs, options), errors,
                             options);
}

DirectionBasis hidden_directions(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                 ErrorCorrelation errors, const ObservabilityOptions& options) {
  const Surroundings around =
      problem.mode == Mode::planar
          ? look_around_in_plane(problem, Q, T_a_b, sum_blocks(problem.blocks).count, options)
          : look_around(problem, Q, T_a_b, errors, options);
  return {around.hidden_vectors(), around.length};
}

DirectionBasis flat_directions(const Matrix8d& Q_metres, const DualQuaternion& T_a_b) {
  DirectionBasis flat;
  flat.length = detail::length_scale(Q_metres);
  const Matrix8d Q = detail::in_units_of(flat.length, Q_metres);
  const DualQuaternion q = detail::in_units_of(flat.length, T_a_b);
  const Matrix86d T = detail::frame_a_basis(q);
  const Matrix6d H = T.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, q)) * T;
  const Matrix86d absolute = T.cwiseAbs();
  const double size = absolute.cwiseProduct(Q.cwiseAbs().lazyProduct(absolute)).colwise().sum().maxCoeff();
  if (exceeds(H, 64 * epsilon * size)) {
    flat.basis.resize(6, 0);
    return flat;
  }
  const Spectrum all = spectrum(H);
  int count = 0;
  while (count < 6 && !(all.curvatures[count] > 64 * epsilon * size)) ++count;
  flat.basis = all.vectors.leftCols(count);
  return flat;
}

}  // namespace egocal
