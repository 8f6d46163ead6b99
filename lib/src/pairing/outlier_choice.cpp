// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/outlier_choice.hpp"

#include "egocal/estimation/weighting.hpp"

namespace egocal {

namespace {

/// Proves the choice among blocks of instants, which StrideSums judges by the motions within each.
std::optional<OutlierProof> prove_sums(const StrideSumsState& sums, Problem problem) {
  StrideBlocks all = sums.committed;
  all.leave_out(std::vector<std::uint8_t>(all.blocks(), 0));
  const std::optional<WeightChoice> suggested = residual_weights(all, problem.mode);
  if (!suggested) return std::nullopt;
  problem.balance = {0, 1};
  std::vector<bool> outlier(sums.outlier.begin(), sums.outlier.end());
  outlier.resize(all.blocks(), false);
  return prove_outliers(problem, all.within(suggested->weights), outlier,
                        static_cast<int>(all.state().block_length));
}

}  // namespace

std::optional<OutlierProof> prove_outliers(const MotionPairing& pairing) {
  const PairingOptions& options = pairing.options();
  if (!options.robust || options.mode == Mode::planar) return std::nullopt;
  const AccumulatorState state = pairing.state().accumulator;
  Problem problem;
  problem.balance = state.choice.balance;
  if (state.sums && state.sums->choice && state.sums->choice->beats_single)
    return prove_sums(*state.sums, problem);
  for (const AccumulatorState::PerStride& entry : state.strides)
    if (entry.stride == state.choice.stride) return prove_outliers(problem, entry.statistics, entry.stride);
  return std::nullopt;
}

}  // namespace egocal
