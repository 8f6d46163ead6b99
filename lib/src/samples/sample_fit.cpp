// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/sample_fit.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/solvers/global.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "problem/tangent.hpp"
#include "samples/shared_poses.hpp"

namespace egocal::detail {

namespace {

Eigen::Vector3d position(const DualQuaternion& q) {
  return 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
}

/// Sums over samples about their mean: all motions between two samples, divided by the number of samples.
/// Positions are taken from `origin`: there 2 |y.dual| is the distance, whatever the rotation of y.
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
                      const DualQuaternion& X, double shown) {
  const Matrix8d rotation = in_units_of(length, cost_matrix(statistics, {1 / noise.rotation, 0}));
  const Matrix8d position = in_units_of(length, cost_matrix(statistics, {0, 1 / noise.translation}));
  const Matrix86d T = tangent_basis(in_units_of(length, X));
  const Matrix6d H_r = T.transpose() * rotation * T, H_p = T.transpose() * position * T;
  const Matrix6d H = H_r + H_p;
  Vector6d scale;
  for (int i = 0; i < 6; ++i) scale[i] = H(i, i) > 0 ? 1 / std::sqrt(H(i, i)) : 0;
  const SymmetricEigen<6> eigen = symmetric_eigen<6>(scale.asDiagonal() * H * scale.asDiagonal());
  Determined result;
  for (int i = 0; i < 6; ++i) {
    if (!(eigen.values[i] > shown)) continue;
    const Vector6d v = scale.asDiagonal() * eigen.vectors.col(i);
    result.by_rotations += v.dot(H_r * v) / eigen.values[i];
    result.by_positions += v.dot(H_p * v) / eigen.values[i];
  }
  return result;
}

/// The cost (18) of the weighted sums, and of an X that is far away: 4 |dual|^2 is the squared distance.
Matrix8d cost_with_prior(const Statistics& statistics, const SampleNoise& noise, double farthest) {
  Matrix8d Q = cost_matrix(statistics, balance_of(noise));
  Q.bottomRightCorner<4, 4>().diagonal().array() +=
      noise.rotation / (statistics.weight * farthest * farthest);
  return Q;
}

struct SumOfSquares {
  double rotation = 0, translation = 0;  ///< [rad^2], [m^2]
  double dof_rotation = 0, dof_translation = 0;
};

/// Variances from residuals. With few degrees of freedom their ratio is drawn towards length^2.
SampleNoise noise_from(const SumOfSquares& squares, double length, const FitSettings& settings) {
  const double least_r = settings.rounding * settings.rounding, least_t = least_r * length * length;
  const double dof_r = std::max(squares.dof_rotation, 0.5), dof_t = std::max(squares.dof_translation, 0.5);
  const double variance_r = std::max(squares.rotation / dof_r, least_r);
  const double variance_t = std::max(squares.translation / dof_t, least_t);
  const double uncertain = 2 / dof_r + 2 / dof_t, prior = settings.prior_log_ratio * settings.prior_log_ratio;
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

/// Squares about the mean from the residuals themselves: of exact samples the quadratic forms hold nothing
/// but rounding of either sign. Each residual's square is multiplied by its weight.
SumOfSquares squares_about_mean(const SampleSet& set, std::span<const std::size_t> chosen,
                                const std::vector<double>& signs, const Eigen::Vector3d& origin,
                                const DualQuaternion& X, const std::vector<double>& weights) {
  std::vector<DualQuaternion> seen;
  QuaternionVector mean_real = QuaternionVector::Zero(), mean_dual = QuaternionVector::Zero();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const DualQuaternion y = shifted(set.seen(chosen[k]).with(X), -origin);
    seen.push_back({signs[k] * y.real, signs[k] * y.dual});
    mean_real += seen.back().real / static_cast<double>(chosen.size());
    mean_dual += seen.back().dual / static_cast<double>(chosen.size());
  }
  SumOfSquares squares;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    // half an angle, and half a distance
    squares.rotation += weights[k] * 4 * (seen[k].real - mean_real).squaredNorm();
    squares.translation += weights[k] * 4 * (seen[k].dual - mean_dual).squaredNorm();
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
    const DualQuaternion y = set.seen(chosen[k]).with(X);
    real += signs[k] * y.real;
    where += position(y) / static_cast<double>(chosen.size());
  }
  if (!(real.norm() > 0)) real = QuaternionVector::UnitX();
  real.normalize();
  return shifted({real, QuaternionVector::Zero()}, where);
}

/// The same from the quadratic forms.
SumOfSquares squares_of_forms(const Statistics& statistics, const DualQuaternion& X) {
  const Vector8d q = X.vec();
  SumOfSquares squares;
  squares.rotation = 4 * X.real.dot(statistics.dual_rows.bottomRightCorner<4, 4>() * X.real);
  squares.translation = 4 * q.dot(statistics.dual_rows * q);
  return squares;
}

double cost_of(const SumOfSquares& squares, const SampleNoise& noise) {
  return squares.rotation / noise.rotation + squares.translation / noise.translation;
}

/// Samples of one unit may have one error: each unit counts as much as any other.
std::vector<double> unit_weights(const SampleSet& set, std::span<const std::size_t> chosen) {
  std::vector<double> members(set.units(), 0.0), weights;
  for (const std::size_t i : chosen) members[set.unit(i)] += 1;
  for (const std::size_t i : chosen) weights.push_back(1 / members[set.unit(i)]);
  return weights;
}

/// One fit on its way: rounds of weights, signs and the target's position.
class Rounds {
 public:
  Rounds(const SampleSet& set, std::span<const std::size_t> chosen, const FitSettings& settings)
      : set_(set), chosen_(chosen), settings_(settings) {
    const std::optional<SampleFit>& start = settings.start;
    fit_.noise = settings.noise.value_or(start ? start->noise : SampleNoise{1, set.length() * set.length()});
    if (!settings.signs.empty())
      signs_ = settings.signs;
    else
      signs_ = start ? signs_towards(set, chosen, *start) : first_signs(set, chosen);
    units_ = set.units_among(chosen);
    if (units_ < chosen.size()) weights_ = unit_weights(set, chosen);
    origin_ = start ? position(start->Y) : Eigen::Vector3d::Zero();
    sum();
  }

  SampleFit fit() {
    const bool exact = settings_.precision == FitPrecision::exact;
    for (int round = 0; round < settings_.most_rounds; ++round)
      if (once(false) && (round > 0 || !exact)) break;
    if (!exact) return fit_;
    for (int round = 0; round < settings_.most_rounds; ++round)
      if (once(true)) break;
    return fit_;
  }

 private:
  void sum() {
    sums_ = SampleSums();
    for (std::size_t k = 0; k < chosen_.size(); ++k) sums_.add(set_.sums(chosen_[k]), signs_[k]);
  }

  /// One round; true where nothing moved that matters. exact: from the samples, not from their sums.
  bool once(bool exact) {
    const double length = set_.length();
    fit_.statistics = exact ? centred(set_, chosen_, signs_, origin_) : sums_.centred(origin_);
    fit_.X = solve_dual(cost_with_prior(fit_.statistics, fit_.noise, settings_.farthest * length)).q;
    fit_.Y = exact ? mean_target(set_, chosen_, signs_, fit_.X) : sums_.mean_target(fit_.X);
    SumOfSquares squares = squares_of_forms(fit_.statistics, fit_.X);
    const double n = static_cast<double>(chosen_.size()), units = static_cast<double>(units_);
    const double least = n * settings_.rounding_of_sums * settings_.rounding_of_sums;
    if (exact || squares.rotation < least || squares.translation < least * length * length)
      squares =
          squares_about_mean(set_, chosen_, signs_, origin_, fit_.X, std::vector<double>(chosen_.size(), 1));
    SumOfSquares of_units = squares;
    if (units_ < chosen_.size())
      of_units = squares_about_mean(set_, chosen_, signs_, origin_, fit_.X, weights_);
    if (exact || !parts_) parts_ = determined(fit_.statistics, fit_.noise, length, fit_.X, settings_.shown);
    of_units.dof_rotation = 3 * (units - 1) - parts_->by_rotations;
    of_units.dof_translation = 3 * (units - 1) - parts_->by_positions;
    const SampleNoise before = fit_.noise;
    if (!settings_.noise) fit_.noise = noise_from(of_units, length, settings_);
    fit_.cost = cost_of(squares, fit_.noise);
    fit_.dof = of_units.dof_rotation + of_units.dof_translation;
    fit_.variance = cost_of(of_units, fit_.noise) / fit_.dof;
    const double moved = (position(fit_.Y) - origin_).norm() / length;
    const double reweighted =
        std::abs(std::log(balance_of(fit_.noise).translation / balance_of(before).translation));
    origin_ = position(fit_.Y);
    std::vector<double> next = signs_towards(set_, chosen_, fit_);
    const bool same = next == signs_;
    signs_ = std::move(next);
    if (!same) sum();
    const bool on_the_way = settings_.precision == FitPrecision::on_the_way;
    return same && moved < (on_the_way ? settings_.settled_on_the_way : settings_.settled_target) &&
           reweighted < (on_the_way ? settings_.settled_on_the_way : settings_.settled_weights);
  }

  const SampleSet& set_;
  std::span<const std::size_t> chosen_;
  const FitSettings& settings_;
  SampleFit fit_;
  std::size_t units_ = 0;        ///< among the chosen samples
  std::vector<double> weights_;  ///< of the squares, per chosen sample, where some share a unit
  SampleSums sums_;
  std::optional<Determined> parts_;  ///< changes little from round to round
  std::vector<double> signs_;
  Eigen::Vector3d origin_;
};

}  // namespace

SampleSet::SampleSet(std::span<const PoseSample> samples) : samples_(samples.begin(), samples.end()) {
  const auto n = static_cast<double>(samples.size());
  for (const PoseSample& sample : samples) middle_ += position(sample.a) / n;
  double squares = 0;
  seen_.reserve(samples.size());
  sums_.reserve(samples.size());
  for (const PoseSample& sample : samples) {
    const DualQuaternion a = shifted(sample.a, -middle_), c = conjugate(sample.b);
    const Eigen::Matrix4d left_real = left_matrix(a.real), left_dual = left_matrix(a.dual);
    const Eigen::Matrix4d right_real = right_matrix(c.real), right_dual = right_matrix(c.dual);
    seen_.push_back({left_real * right_real, left_dual * right_real + left_real * right_dual});
    sums_.push_back(sums_of(seen_.back(), a.real));
    squares += (position(c).squaredNorm() + position(a).squaredNorm()) / (2 * n);
  }
  if (squares > 0) length_ = std::sqrt(squares);
  units_ = units_of(samples_, length_);
  for (const std::size_t unit : units_) number_of_units_ = std::max(number_of_units_, unit + 1);
}

std::size_t SampleSet::units_among(std::span<const std::size_t> chosen) const {
  if (number_of_units_ == size()) return chosen.size();
  std::vector<bool> met(number_of_units_, false);
  for (const std::size_t i : chosen) met[units_[i]] = true;
  return static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
}

double SampleSet::sign(std::size_t i, std::size_t j) const {
  const double a = samples_[i].a.real.dot(samples_[j].a.real), b = samples_[i].b.real.dot(samples_[j].b.real);
  return (a < 0) == (b < 0) ? 1 : -1;
}

SquaredResidual squared_residual(const SampleSet& set, std::size_t i, const SampleFit& fit) {
  const DualQuaternion y = set.seen(i).with(fit.X);
  const double angle = rotation_angle(quaternion_product(quaternion_conjugate(fit.Y.real), y.real));
  return {angle * angle, (position(y) - position(fit.Y)).squaredNorm()};
}

double improvement(const SampleNoise& given, const SampleNoise& other) {
  return std::sqrt(given.rotation / other.rotation) * std::sqrt(given.translation / other.translation);
}

double improvement(const SampleFit& given, const SampleFit& other) {
  return improvement(given.noise, other.noise);
}

bool clearly_better(const SampleFit& one, const SampleFit& other) {
  constexpr double least = 1.1;  // far above rounding; other minima are worse by much more
  return improvement(other, one) > least;
}

DualQuaternion target_at(const SampleSet& set, std::span<const std::size_t> chosen, const SampleFit& fit,
                         const DualQuaternion& X) {
  return mean_target(set, chosen, signs_towards(set, chosen, fit), X);
}

double largest_noise(const SampleSet& set, const SampleNoise& noise) {
  return std::max(std::sqrt(noise.rotation), std::sqrt(noise.translation) / set.length());
}

Balance balance_of(const SampleNoise& noise) {
  return {1, noise.rotation / noise.translation};
}

SampleFit fit_samples(const SampleSet& set, std::span<const std::size_t> chosen,
                      const FitSettings& settings) {
  return Rounds(set, chosen, settings).fit();
}

}  // namespace egocal::detail
