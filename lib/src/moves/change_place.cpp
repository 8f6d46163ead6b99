// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/change_place.hpp"

#include <algorithm>
#include <vector>

#include "egocal/statistics/median.hpp"
#include "moves/linear_blocks.hpp"

namespace egocal::detail {

namespace {

/// Noise of one parameter and pair, by the answer that fits better; residuals above `most` count as `most`.
double noise_of(const std::vector<double>& fits, double most, Mode mode) {
  double noise = 0;
  for (const double fit : fits) noise += std::min(fit, most);
  const double parameters = mode == Mode::planar ? 3 : 6;
  return noise / (parameters * static_cast<double>(fits.size()));
}

}  // namespace

ChangePlace locate_change(std::span<const MotionPair> pairs, const Problem& problem,
                          const DualQuaternion& before, const DualQuaternion& after, double correlation,
                          std::size_t overlap, const MovesOptions& options) {
  std::vector<double> first, second, fits;
  for (const MotionPair& pair : pairs) {
    first.push_back(pair_residual(pair, before, problem.balance));
    second.push_back(pair_residual(pair, after, problem.balance));
    fits.push_back(std::min(first.back(), second.back()));
  }
  const double most = options.place_residual * median(fits);  // larger residuals do not decide

  // cost of every division: `second` for all pairs, then `first` in its place for the pairs before the
  // division
  double sum = 0;
  for (const double value : second) sum += std::min(value, most);
  std::vector<double> total = {sum};
  for (std::size_t i = 0; i < first.size(); ++i) {
    sum += std::min(first[i], most) - std::min(second[i], most);
    total.push_back(sum);
  }
  const std::size_t margin = std::min(options.block_pairs, total.size() / 2 - 1);
  const auto least = std::min_element(total.begin() + static_cast<std::ptrdiff_t>(margin),
                                      total.end() - static_cast<std::ptrdiff_t>(margin));
  const double limit = *least + options.time_interval * noise_of(fits, most, problem.mode) * correlation *
                                    static_cast<double>(overlap);
  ChangePlace result;
  result.at = static_cast<std::size_t>(least - total.begin());
  result.earliest = result.latest = result.at;
  for (std::size_t i = 0; i < total.size(); ++i) {
    if (total[i] > limit) continue;
    result.earliest = std::min(result.earliest, i);
    result.latest = std::max(result.latest, i);
  }
  return result;
}

}  // namespace egocal::detail
