// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/missed_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace egocal::detail {

double missed_noise(const std::vector<double>& strides, const std::vector<double>& weights, double growth,
                    std::uint64_t block_length) {
  const auto longest = static_cast<std::size_t>(strides.back());
  if (!(growth > 0) || 2 * block_length >= longest) return 1;
  const auto length = static_cast<std::size_t>(block_length);
  // The noise that each pose and each step adds to the motions with an end in the block; for steps its
  // differences.
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
