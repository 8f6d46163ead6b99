// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/trial_spread.hpp"

#include "estimation/missed_noise.hpp"
#include "estimation/noise_growth.hpp"

namespace egocal::detail {

namespace {

/// By how much the noise of motions grows with their steps, relative to that of
/// poses: what the residuals of the rotations show beyond doubt, or in the
/// plane most likely. Those of translations also grow with the rotations'
/// noise. Noise that is forgotten within a block of instants is noise on poses
/// as far as omitting blocks is concerned.
double noise_growth(const StrideLadder& ladder, const StrideResiduals& residual, std::uint64_t block_length,
                    Mode mode, const WeightingOptions& options) {
  const double evidence = mode == Mode::planar ? options.growth_evidence_in_plane : options.growth_evidence;
  StrideVariances seen{ladder.strides, residual.rotation, independent_motions(ladder, ladder.turns)};
  for (std::size_t i = 0; i < ladder.size(); ++i)
    if (ladder.strides[i] < static_cast<double>(block_length)) seen.independent[i] = 0;
  return least_growth(seen, growth_grid(options.residuals), evidence);
}

}  // namespace

TrialSpread::TrialSpread(const TouchingSums& sums, Problem problem, const StrideLadder& ladder,
                         const StrideResiduals& residual, std::uint64_t block_length,
                         const WeightingOptions& options)
    : sums_(sums),
      problem_(std::move(problem)),
      ladder_(ladder),
      block_length_(block_length),
      least_blocks_(options.least_blocks),
      growth_(noise_growth(ladder, residual, block_length, problem_.mode, options)) {}

bool TrialSpread::set(const StrideWeights& weights) {
  sums_.weighted(weights).fill(problem_);
  weights_ = weights;
  return problem_.blocks.size() >= least_blocks_;
}

SpreadByPoses TrialSpread::spread(const SeenDirections& seen) const {
  SpreadByPoses result = spread_by_poses(problem_, seen);
  const auto missed = [&](const std::vector<double>& weights) {
    return missed_noise(ladder_.strides, weights, growth_, block_length_);
  };
  result.widen(missed(weights_.rotation), missed(weights_.translation));
  return result;
}

}  // namespace egocal::detail
