// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scale/scale_segments.hpp"

namespace egocal::detail {

/// The logarithm of the scale of some consecutive motions; 1 / weight is its variance, up to a factor that is
/// common to all.
struct ScaleBlock {
  double log_scale = 0, weight = 0;
  double time = 0;        ///< where the motions are that show it [us], since the first one
  std::size_t begin = 0;  ///< index of its first sample
};

/// The scale of some samples; 0 where they show none.
double estimate(std::span<const ScaleSample> samples);

/// At most `count` blocks, which all show the scale about equally well, however long a vehicle stands or
/// turns in place meanwhile. Empty where one of them shows no scale.
std::vector<ScaleBlock> blocks_of(std::span<const ScaleSample> samples, std::size_t count);

/// Weighted least squares over blocks.
struct BlockFit {
  std::vector<double> values;  ///< of the model, one a block
  double cost = 0;             ///< weighted squares left
};

/// A level for each part. splits: the first blocks of all parts but the first one, ascending.
BlockFit fit_steps(std::span<const ScaleBlock> blocks, const std::vector<std::size_t>& splits);
BlockFit fit_line(std::span<const ScaleBlock> blocks);

/// The `count` splits of the least cost whose parts have so many blocks at least; empty where the blocks are
/// too few.
std::vector<std::size_t> best_splits(std::span<const ScaleBlock> blocks, std::size_t count,
                                     std::size_t least_part);

/// How much more sums of neighbouring residuals vary than those of independent ones would, >= 1.
double correlation_of(std::span<const ScaleBlock> blocks, const BlockFit& fit);

/// Chance that a model of so many more numbers than one scale reduces the cost by this much where the scale
/// is one, at one of `places`.
double chance_of(std::span<const ScaleBlock> blocks, const BlockFit& one, const BlockFit& model,
                 double numbers, double places);

}  // namespace egocal::detail
