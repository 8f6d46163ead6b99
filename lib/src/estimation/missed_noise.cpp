// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/missed_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace egocal::detail {

double least_growth(const StrideVariances& seen, const std::vector<double>& growths, double errors) {
  // The logarithm of a variance of n motions with three axes each has the variance 2 / (3 n).
  constexpr double variance_of_one = 2.0 / 3;
  std::vector<double> misfits;
  for (const double growth : growths) {
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
    misfits.push_back(squares / variance_of_one);
  }
  const double limit = *std::min_element(misfits.begin(), misfits.end()) + errors * errors;
  const auto first =
      std::find_if(misfits.begin(), misfits.end(), [&](double misfit) { return misfit <= limit; });
  return growths[static_cast<std::size_t>(first - misfits.begin())];
}

double missed_noise(const std::vector<double>& strides, const std::vector<double>& weights, double growth,
                    std::uint64_t block_length) {
  const auto longest = static_cast<std::size_t>(strides.back());
  if (!(growth > 0) || 2 * block_length >= longest) return 1;
  const auto length = static_cast<std::size_t>(block_length);
  // What each pose and each step adds to the motions with an end in the block; steps by their differences.
  const std::size_t begin = longest, end = longest + length, size = 2 * longest + length;
  std::vector<double> poses(size, 0.0), steps(size, 0.0);
  double spanning = 0;  // what a step adds to all motions
  for (std::size_t i = 0; i < strides.size(); ++i) {
    const auto stride = static_cast<std::size_t>(strides[i]);
    spanning += weights[i] * strides[i];
    for (std::size_t first = begin - stride; first < end; ++first) {
      const std::size_t last = first + stride;
      if (first < begin && last >= end) continue;  // spans the block
      poses[first] -= weights[i];
      poses[last] += weights[i];
      steps[first] += weights[i];
      steps[last] -= weights[i];
    }
  }
  double touching = 0, now = 0;
  for (std::size_t i = 0; i < size; ++i) {
    now += steps[i];
    touching += poses[i] * poses[i] + growth * now * now;
  }
  const double all = growth * spanning * spanning * static_cast<double>(length);
  return touching > 0 ? std::sqrt(std::max(1.0, all / touching)) : 1;
}

}  // namespace egocal::detail
