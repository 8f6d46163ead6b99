// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions of one stride, as the rival of a weighted sum over many.
#pragma once

#include "estimation/trial_spread.hpp"

namespace egocal::detail {

/// The rival's stride and balance, summed as the sums over strides are: without jumps.
struct StrideAlone {
  StrideWeights weights;
  SpreadByPoses spread;
};

/// What the motions of the rival say of its own answer and of others.
class SingleStrideRival {
 public:
  /// rival and options must outlive it.
  SingleStrideRival(const SingleStride& rival, const WeightingOptions& options);

  /// Whether the rival's own answer leaves far more of its motions than q does: it is at a wrong minimum.
  bool is_refuted_by(const DualQuaternion& q) const;
  /// Whether q leaves far more of the rival's motions than the rival's own answer does.
  bool refutes(const DualQuaternion& q) const;
  /// Whether the sum's spread is clearly smaller. mean_stride: of the sum
  /// [steps]. in_force: the sum has the place already. trial: changed, the
  /// rival's stride is put on trial.
  bool is_beaten_by(const SpreadByPoses& sum, double mean_stride, bool in_force, const StrideLadder& ladder,
                    TrialSpread& trial, const SeenDirections& seen) const;
  /// The rival's stride without the motions across jumps, which the rival itself holds, where that makes its
  /// spread clearly smaller. Empty also where there is no jump. trial: changed.
  std::optional<StrideAlone> without_jumps(const StrideLadder& ladder, TrialSpread& trial,
                                           const SeenDirections& seen) const;

 private:
  std::optional<std::size_t> place_in(const StrideLadder& ladder) const;
  StrideWeights alone(const StrideLadder& ladder, std::size_t place) const;
  std::optional<SpreadByPoses> own_spread(const SeenDirections& seen) const;
  double misfit_of(const DualQuaternion& q) const;

  const SingleStride& rival_;
  const WeightingOptions& options_;
  Statistics sum_;
  double own_misfit_ = 0;
};

}  // namespace egocal::detail
