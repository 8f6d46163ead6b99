// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/noise_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace egocal::detail {

namespace {

/// What this growth leaves of the logarithms of the variances: their weighted squares about the mean.
double squares_left(const StrideVariances& seen, double growth) {
  double total = 0, mean = 0, squares = 0;
  for (std::size_t i = 0; i < seen.strides.size(); ++i) {
    const double count = seen.independent[i];
    if (!(count > 0)) continue;
    total += count;
    const double log_ratio = std::log(seen.variances[i] / (2 + growth * seen.strides[i]));
    const double step = log_ratio - mean;
    mean += count / total * step;
    squares += count * step * (log_ratio - mean);
  }
  return squares;
}

/// Chi-square of each growth.
std::vector<double> squares_of(const StrideVariances& seen, const std::vector<double>& growths) {
  // The logarithm of a variance of n motions with three axes each has the variance 2 / (3 n).
  constexpr double variance_of_one = 2.0 / 3;
  std::vector<double> result;
  result.reserve(growths.size());
  for (const double growth : growths) result.push_back(squares_left(seen, growth) / variance_of_one);
  return result;
}

}  // namespace

std::optional<double> best_growth(const StrideVariances& seen, const std::vector<double>& growths) {
  if (std::none_of(seen.independent.begin(), seen.independent.end(), [](double count) { return count > 0; }))
    return std::nullopt;
  std::optional<double> result;
  double least = std::numeric_limits<double>::infinity();
  for (const double growth : growths) {
    const double squares = squares_left(seen, growth);
    if (!(squares < least)) continue;
    least = squares;
    result = growth;
  }
  return result;
}

double least_growth(const StrideVariances& seen, const std::vector<double>& growths, double errors) {
  const std::vector<double> squares = squares_of(seen, growths);
  const double limit = *std::min_element(squares.begin(), squares.end()) + errors * errors;
  const auto first = std::find_if(squares.begin(), squares.end(), [&](double here) { return here <= limit; });
  return growths[static_cast<std::size_t>(first - squares.begin())];
}

bool NoiseFit::refutes(double growth, double errors) const {
  return squares_of(used, {growth}).front() > least + errors * errors;
}

NoiseFit fit_noise(const StrideVariances& seen, const std::vector<double>& growths,
                   double least_independent) {
  NoiseFit fit{seen, 0, std::numeric_limits<double>::infinity()};
  double freedom = -2;  // the common factor and the growth
  for (double& count : fit.used.independent) {
    if (count < least_independent) count = 0;
    if (count > 0) ++freedom;
  }
  const std::vector<double> squares = squares_of(fit.used, growths);
  fit.least = *std::min_element(squares.begin(), squares.end());
  if (freedom > 0) fit.misfit = fit.least / freedom;
  return fit;
}

}  // namespace egocal::detail
