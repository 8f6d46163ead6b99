// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace egocal::detail {

/// Mean squared residuals of many strides. Noise on poses and on motions together gives motions of s steps
/// the variance 2 + growth * s, up to a common factor.
struct StrideVariances {
  std::vector<double> strides;      ///< [steps]
  std::vector<double> variances;    ///< mean squared residuals of one motion
  std::vector<double> independent;  ///< motions that share no step; 0: not used
};

/// The first of these growths that fits best. Empty where no stride is used, or none fits.
std::optional<double> best_growth(const StrideVariances& seen, const std::vector<double>& growths);

/// The smallest of these growths (ascending) that fits within `errors` standard errors of the best one.
double least_growth(const StrideVariances& seen, const std::vector<double>& growths, double errors);

/// How well such noise explains the residuals, for the strides with at least `least_independent` motions.
struct NoiseFit {
  StrideVariances used;
  double least = 0;  ///< chi-square of the best growth
  /// The same per degree of freedom: about one or less if the noise is of this kind. Infinite with less than
  /// three strides.
  double misfit = 0;

  /// Whether this growth is farther from the best one than this many standard errors.
  bool refutes(double growth, double errors) const;
};
NoiseFit fit_noise(const StrideVariances& seen, const std::vector<double>& growths, double least_independent);

}  // namespace egocal::detail
