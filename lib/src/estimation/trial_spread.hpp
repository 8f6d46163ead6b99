// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How far the answers of weights on trial scatter.
#pragma once

#include <cstdint>

#include "estimation/spread_by_poses.hpp"
#include "estimation/stride_ladder.hpp"

namespace egocal::detail {

/// The spread of the answer when blocks of instants are omitted, of one choice
/// of weights after another.
class TrialSpread {
 public:
  /// residual: at the answer that the residuals suggest; they tell how noise
  /// grows with the steps. block_length: instants. sums, ladder and options
  /// must outlive it.
  TrialSpread(const TouchingSums& sums, Problem problem, const StrideLadder& ladder,
              const StrideResiduals& residual, std::uint64_t block_length, const WeightingOptions& options);

  /// Puts these weights on trial. False where the blocks are too few for a
  /// spread.
  bool set(const StrideWeights& weights);
  /// The directions that the motions show by the weights on trial.
  SeenDirections seen() const { return seen_directions(problem_); }
  /// The spread by the weights on trial, with the noise that omitting blocks misses.
  SpreadByPoses spread(const SeenDirections& seen) const;

 private:
  const TouchingSums& sums_;
  Problem problem_;
  const StrideLadder& ladder_;
  std::uint64_t block_length_;
  std::size_t least_blocks_;
  double growth_;
  StrideWeights weights_;
};

}  // namespace egocal::detail
