// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// X and Y of a X = Y b from samples that are given, and the noise that is left.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "samples/sample_sums.hpp"

namespace egocal::detail {

/// Variance of one sample, each axis.
struct SampleNoise {
  double rotation = 1;     ///< [rad^2]
  double translation = 1;  ///< [m^2]
};

/// Samples ready to be fitted, with the origin of a's world in the middle of a's positions.
class SampleSet {
 public:
  explicit SampleSet(std::span<const PoseSample> samples);

  std::size_t size() const { return seen_.size(); }
  /// The length that makes rotations and translations comparable: distance of the target and of the sensors
  /// from each other [m].
  double length() const { return length_; }
  const Eigen::Vector3d& middle() const { return middle_; }
  const SeenTarget& seen(std::size_t i) const { return seen_[i]; }
  const SampleSums& sums(std::size_t i) const { return sums_[i]; }
  const PoseSample& sample(std::size_t i) const { return samples_[i]; }
  /// Number of the unit that the sample belongs to; most samples are one of their own (shared_poses.hpp).
  std::size_t unit(std::size_t i) const { return units_[i]; }
  std::size_t units() const { return number_of_units_; }
  /// Different units among these samples.
  std::size_t units_among(std::span<const std::size_t> chosen) const;
  /// +1 or -1: whether the quaternions of the motion between two samples have scalars of one sign.
  double sign(std::size_t i, std::size_t j) const;

 private:
  std::vector<PoseSample> samples_;
  std::vector<SeenTarget> seen_;
  std::vector<SampleSums> sums_;
  std::vector<std::size_t> units_;
  std::size_t number_of_units_ = 0;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double length_ = 1;
};

/// The fit of some samples.
struct SampleFit {
  DualQuaternion X, Y;  ///< Y: with the world of a in the middle()
  SampleNoise noise;
  Statistics statistics;  ///< of the weighted cost, rotation and position uncoupled; count: motions
  double cost = 0;        ///< squared residuals over the variances
  double dof = 0;         ///< of the cost, where all samples of one unit count once
  double variance = 0;    ///< cost of one degree of freedom: 1, except for a noise that was given
};

/// Residuals of one sample against a fit: squared angle [rad^2] and squared distance [m^2].
struct SquaredResidual {
  double rotation = 0, translation = 0;
};
SquaredResidual squared_residual(const SampleSet& set, std::size_t i, const SampleFit& fit);

/// Squared residuals of one noise over those of another, rotation and position alike.
double improvement(const SampleNoise& given, const SampleNoise& other);
double improvement(const SampleFit& given, const SampleFit& other);
/// Whether `one` is better by more than rounding, and so not the same minimum again.
bool clearly_better(const SampleFit& one, const SampleFit& other);

/// The mean of the targets that the chosen samples see with this X; `fit` gives the signs.
DualQuaternion target_at(const SampleSet& set, std::span<const std::size_t> chosen, const SampleFit& fit,
                         const DualQuaternion& X);

/// Standard deviation of one sample, in radians or in parts of the length: the larger one.
double largest_noise(const SampleSet& set, const SampleNoise& noise);

/// The balance of cost_matrix() for a noise.
Balance balance_of(const SampleNoise& noise);

/// on_the_way: weights to a hundredth, for choices among samples; exact: the sums are made from the samples
/// themselves, and everything has settled.
enum class FitPrecision { on_the_way, exact };

/// How fit_samples() goes about it.
struct FitSettings {
  std::optional<SampleFit> start;  ///< signs of the quaternions and first guess of the target; without it the
                                   ///< signs come from the first chosen sample
  std::vector<double> signs;       ///< of the quaternions, per chosen sample, where known; else empty
  std::optional<SampleNoise> noise;  ///< kept where given, else estimated
  double prior_log_ratio = 2;        ///< of SampleOptions
  /// Rounds of weights and of the target's position; both settle in three to six.
  int most_rounds = 20;
  FitPrecision precision = FitPrecision::exact;
  /// Residuals below this part of a radian, and of the length, are rounding of one sample; of sums of squares
  /// over all, which are differences of large numbers.
  double rounding = 1e-12, rounding_of_sums = 1e-7;
  /// The target has settled where it moves by less than this part of the length, the weights where their
  /// ratio changes by less than this part; on the way, and in the end (tests/lib/test_samples.cpp: the order
  /// of the samples changes no bit, their unit nothing beyond rounding).
  double settled_target = 1e-10, settled_weights = 1e-6, settled_on_the_way = 1e-2;
  /// The sensors are not further from each other than a few lengths: one standard deviation, in lengths, of
  /// where X may be. It holds X where rotations about one axis leave the place along it to noise, which puts
  /// X kilometres away, and what is left of the positions there is no noise of theirs: 38 of 200 such sets of
  /// 6 to 25 samples were called contradictory or doubtful. What samples do show moves by less than a
  /// ten-thousandth of its standard deviation where that is a thousandth of the length.
  double farthest = 10;
  /// Directions with less than this part of the curvature of the best one are not shown: far above the
  /// rounding of the curvature, 1e-15, and far below what any noise leaves.
  double shown = 1e-9;
};

/// Fits the chosen samples (indices, at least 2).
SampleFit fit_samples(const SampleSet& set, std::span<const std::size_t> chosen, const FitSettings& settings);

}  // namespace egocal::detail
