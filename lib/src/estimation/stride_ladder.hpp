// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The sums of motions by stride, as the choice of weights sees them.
#pragma once

#include <utility>
#include <vector>

#include "egocal/estimation/weighting.hpp"

namespace egocal::detail {

/// The sum of each stride, and how many motions and strides it stands for. All
/// vectors are by stride.
struct StrideLadder {
  const ResidualWeightOptions& options;
  std::vector<StrideCell> sums;
  std::vector<double> strides;  ///< steps of one motion, ascending
  std::vector<double> width;    ///< how many strides each represents, at least one
  std::vector<double> motions;  ///< weight of those with a translation; 0: too few
  std::vector<double> turns;    ///< weight of those with a rotation; 0: too few

  /// totals: of the strides of the blocks. tuning must outlive the ladder.
  StrideLadder(const StrideBlocks& blocks, std::vector<StrideCell> totals,
               const ResidualWeightOptions& tuning);

  std::size_t size() const { return strides.size(); }
  /// Motion of all strides, squared: lengths [m^2] and turns.
  std::pair<double, double> squared_size() const;
};

/// Mean squared residuals of one motion of each stride: of the real rows
/// [rad^2] and of the dual rows [m^2].
struct StrideResiduals {
  std::vector<double> rotation, translation;
};

/// q: planar mode: T_p.
StrideResiduals residuals(const StrideLadder& ladder, const DualQuaternion& q);

/// Number of motions of each stride that share no step. counts: all of its motions.
std::vector<double> independent_motions(const StrideLadder& ladder, const std::vector<double>& counts);

/// Grid of the ratio of a random walk's variance a step to that of the noise on
/// poses, ascending. The first one is 0, noise on poses alone: there the fitted
/// weights are those of all strides alike.
std::vector<double> growth_grid(const ResidualWeightOptions& options);

}  // namespace egocal::detail
