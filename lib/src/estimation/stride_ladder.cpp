// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/stride_ladder.hpp"

#include <algorithm>
#include <cmath>

namespace egocal::detail {

StrideLadder::StrideLadder(const StrideBlocks& blocks, std::vector<StrideCell> totals,
                           const ResidualWeightOptions& tuning)
    : options(tuning), sums(std::move(totals)) {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const StrideCell& sum = sums[i];
    const double translations = sum.motions.weight;
    strides.push_back(blocks.strides()[i].stride);
    motions.push_back(sum.motions.count < options.least_motions ? 0 : translations);
    turns.push_back(sum.motions.count + sum.rotations.count < options.least_motions
                        ? 0
                        : translations + sum.rotations.weight);
  }
  std::size_t last = 0;
  for (std::size_t i = 0; i < strides.size(); ++i)
    if (turns[i] > 0) last = i;
  for (std::size_t i = 0; i < strides.size(); ++i) {
    const double low = i > 0 ? 0.5 * (strides[i] + strides[i - 1]) : 0.5;
    const double high = i < last ? 0.5 * (strides[i] + strides[i + 1]) : 2 * strides[i] - low;
    width.push_back(std::max(1.0, high - low));
  }
}

std::pair<double, double> StrideLadder::squared_size() const {
  double lengths = 0, squared_turns = 0;
  for (const StrideCell& sum : sums) {
    lengths += sum.motions.dual_rows.topLeftCorner<4, 4>().trace();
    squared_turns += sum.motions.dual_rows.bottomRightCorner<4, 4>().trace();
  }
  return {lengths, squared_turns};
}

StrideResiduals residuals(const StrideLadder& ladder, const DualQuaternion& q) {
  StrideResiduals result;
  const Vector8d v = q.vec();
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    const Matrix8d& motions = ladder.sums[i].motions.dual_rows;
    const Eigen::Matrix4d turns =
        motions.bottomRightCorner<4, 4>() + ladder.sums[i].rotations.dual_rows.bottomRightCorner<4, 4>();
    const double n_turns = std::max(1.0, ladder.turns[i]), n_motions = std::max(1.0, ladder.motions[i]);
    result.rotation.push_back(std::max(ladder.options.least_variance, q.real.dot(turns * q.real) / n_turns));
    result.translation.push_back(std::max(ladder.options.least_variance, v.dot(motions * v) / n_motions));
  }
  return result;
}

std::vector<double> independent_motions(const StrideLadder& ladder, const std::vector<double>& counts) {
  std::vector<double> result;
  for (std::size_t i = 0; i < ladder.size(); ++i) result.push_back(counts[i] / ladder.strides[i]);
  return result;
}

std::vector<double> growth_grid(const ResidualWeightOptions& options) {
  std::vector<double> result{0};
  for (int k = 0; k <= options.grid; ++k)
    result.push_back(options.least_growth * std::pow(options.most_growth / options.least_growth,
                                                     static_cast<double>(k) / options.grid));
  return result;
}

}  // namespace egocal::detail
