// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/uncertainty/observability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "linear_algebra/small_factor.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/hint.hpp"
#include "uncertainty/planar_observability.hpp"
#include "uncertainty/surroundings.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/variance.hpp"

namespace egocal {

using namespace detail;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Spectrum {
  Matrix6d vectors = Matrix6d::Identity();  ///< columns; dt in units of length, dtheta [rad]
  Vector6d curvatures = Vector6d::Zero();   ///< ascending
};

Spectrum spectrum(const Matrix6d& H) {
  const SymmetricEigen<6> eigen = symmetric_eigen<6>(H);
  return {eigen.vectors, eigen.values};
}

/// Whether all curvatures are larger than that.
bool exceeds(Matrix6d H, double curvature) {
  H.diagonal().array() -= curvature;
  return factorise(H);
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

/// A direction with that translation, and the rotation that costs least with it. An eigenvector mixes a
/// rotation into a translation of nearly its curvature, which they have in these units by chance. clean: the
/// curvatures; what is hidden already stays as it is.
Vector6d followed_by_rotation(const Eigen::Vector3d& translation, const Matrix6d& clean,
                              const Surroundings& around) {
  const auto hidden = around.hidden_vectors();
  const Matrix6d stiff = clean + clean.diagonal().cwiseAbs().sum() * (hidden * hidden.transpose());
  const SmallFactor rotations(stiff.bottomRightCorner<3, 3>());
  Vector6d direction;
  direction << translation, -rotations.solve(UpToSix(stiff.bottomLeftCorner<3, 3>() * translation));
  return direction.normalized();
}

/// Takes a direction to those that are not seen, unless most of it is among them. The others remain
/// orthogonal to it.
void hide(Vector6d direction, double least_new, Surroundings& around) {
  const auto hidden = around.hidden_vectors();
  direction -= hidden * (hidden.transpose() * direction);
  if (!(direction.norm() > least_new)) return;
  // a reflection of those that are seen takes the first of them to it
  const int first = around.hidden++;
  const Vector6d mirror = around.vectors.col(first) - direction.normalized();
  const double squared = mirror.squaredNorm();
  if (!(squared > epsilon)) return;
  for (int k = first; k < 6; ++k)
    around.vectors.col(k) -= 2 / squared * mirror.dot(around.vectors.col(k)) * mirror;
}

/// T' L T, without Eigen's products of large matrices: these would cost twice as much.
Matrix6d in_tangent(const Matrix8d& L, const Matrix86d& T) {
  const Matrix86d product = L.lazyProduct(T);
  return T.transpose().lazyProduct(product);
}

Surroundings look_around(const Problem& problem, const Matrix8d& Q_metres, const DualQuaternion& T_a_b,
                         ErrorCorrelation errors, const ObservabilityOptions& options) {
  Surroundings around;
  for (const Statistics& block : problem.blocks) around.pairs += static_cast<double>(block.count);
  around.length = length_scale(Q_metres);
  const Matrix8d Q = in_units_of(around.length, Q_metres);
  around.q = in_units_of(around.length, T_a_b);
  around.tangent = frame_a_basis(around.q);
  around.H = in_tangent(lagrangian_matrix(Q, least_squares_multipliers(Q, around.q)), around.tangent);

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
      errors == ErrorCorrelation::correlated && blocks_to_omit(problem) >= options.least_blocks;
  const double doubtful =
      floor + (may_share ? 0.25 * around.noise * (options.shared_noise - options.independent_noise) : 0);
  // usually all directions are seen clearly, which a factorisation shows at a tenth of the cost
  if (exceeds(clean, doubtful)) return around;
  const Spectrum seen = spectrum(clean);
  around.vectors = seen.vectors;
  while (around.hidden < 6 && !(seen.curvatures[around.hidden] > floor)) ++around.hidden;
  if (!may_share) return around;
  for (int k = around.hidden; k < 6 && seen.curvatures[k] < doubtful; ++k) {
    const Vector6d direction = seen.vectors.col(k);
    if (!(direction.head<3>().norm() > options.least_translation_part) ||
        shown_by_translations(direction, problem, Q_metres, T_a_b, around.length, options.shown_sigmas))
      break;
    hide(followed_by_rotation(direction.head<3>(), clean, around), options.least_translation_part, around);
  }
  return around;
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
  return spatial_hint(hidden_translations, rotation_hidden, direction);
}

Observability spatial_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                    ErrorCorrelation errors, const ObservabilityOptions& options) {
  const Surroundings around = look_around(problem, Q, T_a_b, errors, options);
  Observability result;
  result.stddev.fill(infinity);
  result.observable = observable_around(around, errors, options);
  result.hint = hint(around, options);
  if (around.hidden == 6 || blocks_to_omit(problem) < options.least_blocks) return result;

  const bool all = around.hidden == 0;
  const Matrix6d basis = all ? Matrix6d::Identity() : Matrix6d(around.vectors.rowwise().reverse());
  const Matrix86d tangent = all ? around.tangent : Matrix86d(around.tangent.lazyProduct(basis));
  const ShownDirections directions{TangentSpace(around.q, around.length, tangent, problem.balance), basis,
                                   6 - around.hidden};
  Vector6d variance = variance_by_blocks(problem, around.pairs, directions, errors, options);
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
    return observable_around(look_around(problem, Q, T_a_b, errors, options), errors, options);
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
  flat.length = length_scale(Q_metres);
  const Matrix8d Q = in_units_of(flat.length, Q_metres);
  const DualQuaternion q = in_units_of(flat.length, T_a_b);
  const Matrix86d T = frame_a_basis(q);
  const Matrix6d H = in_tangent(lagrangian_matrix(Q, least_squares_multipliers(Q, q)), T);
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
