// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/sample_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "egocal/online/answer.hpp"
#include "egocal/solvers/dual.hpp"
#include "solvers/tangent.hpp"

namespace egocal::detail {

namespace {

/// Residuals below this part of a radian, and of the length, are rounding.
constexpr double rounding = 1e-12;
/// The target has settled where it moves by less than this part of the length, the weights where their ratio
/// changes by less than this part.
constexpr double settled_target = 1e-10, settled_weights = 1e-6;

Eigen::Vector3d position(const DualQuaternion& q) {
  return 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
}

DualQuaternion shifted(const DualQuaternion& pose, const Eigen::Vector3d& shift) {
  QuaternionVector t;
  t << 0, shift;
  return {pose.real, pose.dual + 0.5 * quaternion_product(t, pose.real)};
}

/// The target as sample i sees it with this X.
DualQuaternion target_seen(const SeenTarget& seen, const DualQuaternion& X) {
  return {seen.real * X.real, seen.dual * X.real + seen.real * X.dual};
}

/// Sums over samples about their mean: all motions between two samples, divided by their number. Positions
/// are taken from `origin`: there 2 |y.dual| is the distance, whatever the rotation of y.
Statistics centred(const SampleSet& set, std::span<const std::size_t> chosen,
                   const std::vector<double>& signs, const Eigen::Vector3d& origin) {
  QuaternionVector t;
  t << 0, origin;
  const Eigen::Matrix4d half = 0.5 * left_matrix(t);
  const auto n = static_cast<double>(chosen.size());
  std::vector<SeenTarget> moved;
  moved.reserve(chosen.size());
  SeenTarget mean;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const SeenTarget& seen = set.seen(chosen[k]);
    moved.push_back({signs[k] * seen.real, signs[k] * (seen.dual - half * seen.real)});
    mean.real += moved.back().real / n;
    mean.dual += moved.back().dual / n;
  }
  Eigen::Matrix4d dual_dual = Eigen::Matrix4d::Zero(), dual_real = dual_dual, real_real = dual_dual;
  for (const SeenTarget& one : moved) {
    const Eigen::Matrix4d real = one.real - mean.real, dual = one.dual - mean.dual;
    dual_dual.noalias() += dual.transpose() * dual;
    dual_real.noalias() += dual.transpose() * real;
    real_real.noalias() += real.transpose() * real;
  }
  Statistics statistics;
  statistics.dual_rows.topLeftCorner<4, 4>() = 0.5 * (dual_dual + dual_dual.transpose());
  statistics.dual_rows.topRightCorner<4, 4>() = dual_real;
  statistics.dual_rows.bottomLeftCorner<4, 4>() = dual_real.transpose();
  statistics.dual_rows.bottomRightCorner<4, 4>() = 0.5 * (real_real + real_real.transpose());
  statistics.weight = n;
  statistics.count = chosen.size() * (chosen.size() - 1) / 2;
  return statistics;
}

/// Parts of the six degrees of freedom of X that rotations and positions determine; less than six in all
/// where some direction is not shown.
struct Determined {
  double by_rotations = 0, by_positions = 0;
};
Determined determined(const Statistics& statistics, const SampleNoise& noise, double length,
                      const DualQuaternion& X) {
  const Matrix8d rotation = in_units_of(length, cost_matrix(statistics, {1 / noise.rotation, 0}));
  const Matrix8d position = in_units_of(length, cost_matrix(statistics, {0, 1 / noise.translation}));
  const Matrix86d T = tangent_basis(in_units_of(length, X));
  const Matrix6d H_r = T.transpose() * rotation * T, H_p = T.transpose() * position * T;
  const Matrix6d H = H_r + H_p;
  Vector6d scale;
  for (int i = 0; i < 6; ++i) scale[i] = H(i, i) > 0 ? 1 / std::sqrt(H(i, i)) : 0;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scale.asDiagonal() * H * scale.asDiagonal());
  Determined result;
  for (int i = 0; i < 6; ++i) {
    constexpr double shown = 1e-9;
    if (!(eigen.eigenvalues()[i] > shown)) continue;
    const Vector6d v = scale.asDiagonal() * eigen.eigenvectors().col(i);
    result.by_rotations += v.dot(H_r * v) / eigen.eigenvalues()[i];
    result.by_positions += v.dot(H_p * v) / eigen.eigenvalues()[i];
  }
  return result;
}

struct SumOfSquares {
  double rotation = 0, translation = 0;  ///< [rad^2], [m^2]
  double dof_rotation = 0, dof_translation = 0;
};

/// Variances from residuals. With few degrees of freedom their ratio is drawn towards length^2.
SampleNoise noise_from(const SumOfSquares& squares, double length, double prior_log_ratio) {
  const double least_r = rounding * rounding, least_t = least_r * length * length;
  const double dof_r = std::max(squares.dof_rotation, 0.5), dof_t = std::max(squares.dof_translation, 0.5);
  const double variance_r = std::max(squares.rotation / dof_r, least_r);
  const double variance_t = std::max(squares.translation / dof_t, least_t);
  const double uncertain = 2 / dof_r + 2 / dof_t, prior = prior_log_ratio * prior_log_ratio;
  const double away = std::log(variance_t / (variance_r * length * length));
  const double kept = away * prior / (prior + uncertain);
  // the ratio moves, the weighted mean of the logarithms stays
  const double mean =
      (dof_r * std::log(variance_r * length * length) + dof_t * std::log(variance_t)) / (dof_r + dof_t);
  SampleNoise noise;
  noise.rotation = std::exp(mean - kept * dof_t / (dof_r + dof_t)) / (length * length);
  noise.translation = std::exp(mean + kept * dof_r / (dof_r + dof_t));
  return noise;
}

/// From the residuals themselves: of exact samples the quadratic forms hold nothing but rounding of either
/// sign.
SumOfSquares squares_about_mean(const SampleSet& set, std::span<const std::size_t> chosen,
                                const std::vector<double>& signs, const Eigen::Vector3d& origin,
                                const DualQuaternion& X) {
  std::vector<DualQuaternion> seen;
  QuaternionVector mean_real = QuaternionVector::Zero(), mean_dual = QuaternionVector::Zero();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const DualQuaternion y = shifted(target_seen(set.seen(chosen[k]), X), -origin);
    seen.push_back({signs[k] * y.real, signs[k] * y.dual});
    mean_real += seen.back().real / static_cast<double>(chosen.size());
    mean_dual += seen.back().dual / static_cast<double>(chosen.size());
  }
  SumOfSquares squares;
  for (const DualQuaternion& y : seen) {
    // half an angle, and half a distance
    squares.rotation += 4 * (y.real - mean_real).squaredNorm();
    squares.translation += 4 * (y.dual - mean_dual).squaredNorm();
  }
  return squares;
}

std::vector<double> first_signs(const SampleSet& set, std::span<const std::size_t> chosen) {
  std::vector<double> signs;
  for (const std::size_t i : chosen) signs.push_back(set.sign(chosen[0], i));
  return signs;
}

std::vector<double> signs_towards(const SampleSet& set, std::span<const std::size_t> chosen,
                                  const SampleFit& fit) {
  std::vector<double> signs;
  for (const std::size_t i : chosen)
    signs.push_back(fit.Y.real.dot(set.seen(i).real * fit.X.real) < 0 ? -1 : 1);
  return signs;
}

/// The mean of the targets that the chosen samples see.
DualQuaternion mean_target(const SampleSet& set, std::span<const std::size_t> chosen,
                           const std::vector<double>& signs, const DualQuaternion& X) {
  QuaternionVector real = QuaternionVector::Zero();
  Eigen::Vector3d where = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const DualQuaternion y = target_seen(set.seen(chosen[k]), X);
    real += signs[k] * y.real;
    where += position(y) / static_cast<double>(chosen.size());
  }
  if (!(real.norm() > 0)) real = QuaternionVector::UnitX();
  real.normalize();
  return shifted({real, QuaternionVector::Zero()}, where);
}

DualQuaternion minimiser(const Statistics& statistics, const SampleNoise& noise,
                         const std::optional<DualQuaternion>& prior) {
  if (!prior) return solve_dual(cost_matrix(statistics, balance_of(noise))).q;
  Problem problem;
  problem.balance = balance_of(noise);
  problem.blocks = {statistics};
  problem.prior = prior;
  return solve(problem, Method::dual).T_a_b;
}

}  // namespace

SampleSet::SampleSet(std::span<const PoseSample> samples) : samples_(samples.begin(), samples.end()) {
  const auto n = static_cast<double>(samples.size());
  for (const PoseSample& sample : samples) middle_ += position(sample.a) / n;
  double squares = 0;
  for (const PoseSample& sample : samples) {
    const DualQuaternion a = shifted(sample.a, -middle_), c = conjugate(sample.b);
    const Eigen::Matrix4d left_real = left_matrix(a.real), left_dual = left_matrix(a.dual);
    const Eigen::Matrix4d right_real = right_matrix(c.real), right_dual = right_matrix(c.dual);
    seen_.push_back({left_real * right_real, left_dual * right_real + left_real * right_dual});
    squares += (position(c).squaredNorm() + position(a).squaredNorm()) / (2 * n);
  }
  if (squares > 0) length_ = std::sqrt(squares);
}

double SampleSet::sign(std::size_t i, std::size_t j) const {
  const double a = samples_[i].a.real.dot(samples_[j].a.real), b = samples_[i].b.real.dot(samples_[j].b.real);
  return (a < 0) == (b < 0) ? 1 : -1;
}

SquaredResidual squared_residual(const SampleSet& set, std::size_t i, const SampleFit& fit) {
  const DualQuaternion y = target_seen(set.seen(i), fit.X);
  const QuaternionVector difference = quaternion_product(quaternion_conjugate(fit.Y.real), y.real);
  const double angle = 2 * std::atan2(difference.tail<3>().norm(), std::abs(difference[0]));
  return {angle * angle, (position(y) - position(fit.Y)).squaredNorm()};
}

DualQuaternion target_at(const SampleSet& set, std::span<const std::size_t> chosen, const SampleFit& fit,
                         const DualQuaternion& X) {
  return mean_target(set, chosen, signs_towards(set, chosen, fit), X);
}

Balance balance_of(const SampleNoise& noise) {
  return {1, noise.rotation / noise.translation};
}

SampleFit fit_samples(const SampleSet& set, std::span<const std::size_t> chosen,
                      const FitSettings& settings) {
  const std::optional<SampleFit>& start = settings.start;
  SampleFit fit;
  const double length = set.length();
  fit.noise = settings.noise.value_or(start ? start->noise : SampleNoise{1, length * length});
  std::vector<double> signs = start ? signs_towards(set, chosen, *start) : first_signs(set, chosen);
  Eigen::Vector3d origin = start ? position(start->Y) : Eigen::Vector3d::Zero();
  const auto n = static_cast<double>(chosen.size());
  for (int round = 0; round < settings.most_rounds; ++round) {
    const Statistics statistics = centred(set, chosen, signs, origin);
    const DualQuaternion X = minimiser(statistics, fit.noise, settings.prior);
    const DualQuaternion Y = mean_target(set, chosen, signs, X);
    SumOfSquares squares = squares_about_mean(set, chosen, signs, origin, X);
    const Determined parts = determined(statistics, fit.noise, length, X);
    squares.dof_rotation = 3 * (n - 1) - parts.by_rotations;
    squares.dof_translation = 3 * (n - 1) - parts.by_positions;
    const SampleNoise before = fit.noise;
    if (!settings.noise) fit.noise = noise_from(squares, length, settings.prior_log_ratio);
    fit.X = X;
    fit.Y = Y;
    fit.statistics = statistics;
    fit.cost = squares.rotation / fit.noise.rotation + squares.translation / fit.noise.translation;
    fit.dof = squares.dof_rotation + squares.dof_translation;
    const double moved = (position(Y) - origin).norm() / length;
    const double reweighted =
        std::abs(std::log(balance_of(fit.noise).translation / balance_of(before).translation));
    origin = position(Y);
    const std::vector<double> next = signs_towards(set, chosen, fit);
    const bool same = next == signs;
    signs = next;
    if (round > 0 && same && moved < settled_target && reweighted < settled_weights) break;
  }
  return fit;
}

}  // namespace egocal::detail
