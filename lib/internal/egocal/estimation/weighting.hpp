// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "egocal/estimation/stride_blocks.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// Tuning of residual_weights(). Study: the accuracy benchmark (docs/accuracy.md), with these numbers
/// together; they were not varied one by one.
struct ResidualWeightOptions {
  /// Squared residuals of one motion below this are rounding [rad^2, m^2]: 1e-14, a hundred times epsilon.
  double least_variance = 1e-28;
  /// Weights of rotation and translation differ by at most this factor, beyond the square of the motions'
  /// length per turn: noise-free data must not make the cost singular. A thousand in the noise.
  double most_imbalance = 1e6;
  std::uint64_t least_motions = 6;  ///< fewer motions of a stride have no variance: half of it is chance
  /// Spreads below these are rounding, so nothing is to be gained [rad, m] (a change of 1e-12 in the input
  /// chose the setting, docs/method.md).
  double least_rotation_spread = 1e-9, least_translation_spread = 1e-8;
  /// A stride whose motions have this part of the weight of a single step is skipped: 128 steps, and 128
  /// times as long, add 128^2 * 1e-22 = 2e-18 of the sum, less than its rounding.
  double negligible_part = 1e-22;
  int rounds = 4;        ///< of weights and minimiser alternately: bounds the time of a choice
  int later_rounds = 2;  ///< the same where a minimiser is known already
  /// Grid of the ratio of a random walk's variance a step to that of the noise on poses: six points a decade,
  /// from white noise on poses alone to a random walk alone.
  int grid = 24;
  double least_growth = 1e-3, most_growth = 1e3;
  /// Weights before any residual is known: squared residuals of rotation and translation [rad^2, m^2], a
  /// hundredth and a tenth.
  double first_rotation = 1e-4, first_translation = 1e-2;
  /// Least part of a stride's variance of translations that counts as their own. What rotation noise adds is
  /// subtracted, and may scatter beyond all of it. Study: docs/weights.md, "Rotation noise in long motions".
  double least_own_part = 0.1;
  double first_lambda = 0.5;  ///< of the shape before any residual is known: a memory of one and a half steps
};

/// Tuning of choose_weights().
struct WeightingOptions {
  /// Memories [steps] that are tried besides the one that the residuals suggest. Geometric, from "neighbours
  /// only" to "all strides alike": neighbours of the list differ by less than the spread can tell.
  std::vector<double> memories{1, 4, 16, 64, 1e9};
  /// Where noise on poses and on motions explains how the mean squared residuals of rotation and of
  /// translation grow with the stride, no memory is tried that is off by more than `refuted` standard errors
  /// of that growth. Explained: a chi-square of at most this per degree of freedom, of the strides with
  /// enough motions that share no step. Study: 6 machines x 8 kinds of noise x 40 drives (docs/weights.md,
  /// "Noise that the residuals explain"); nine of ten are below 1, noise with a memory of four steps is
  /// above 12.
  double refuted = 3;
  double explained = 2.5, least_independent = 3;
  /// A memory is preferred to what the residuals suggest where its spread is smaller by this many standard
  /// errors of the difference (of the sum of the logarithms of rotation's and translation's). The smallest of
  /// ten noisy spreads misleads: 0.090 instead of 0.075 deg on simulated drives of 200 motions.
  double evidence = 3;
  /// A sum over strides replaces motions of one stride where its spread is smaller by this many standard
  /// errors of the difference, and by `clearly` (sum of the logarithms of rotation's and translation's
  /// spread). On KITTI both are as good to a few percent, and what is left is systematic: a draw changes
  /// nothing.
  double single_evidence = 1;
  double clearly = 0.1;
  /// Where steps far from typical lost weight (JumpOptions::doubtful), more than this part of the weight of
  /// all, the same stride summed here is no longer the rival: the sum replaces it as well where its spread is
  /// smaller by `clearly_unpaired` than the rival's own. Those are spreads of different blocks, and the sum
  /// of the logarithms of two spreads of about 16 blocks scatters by a quarter.
  double taken_off = 0.01;
  double clearly_unpaired = 0.25;
  /// The sum replaces the rival only where the two answers differ by at most this many standard deviations of
  /// the single stride's, in rotation and in translation. Motions of one stride are judged one by one; the
  /// sum omits whole blocks, and many short stretches of wrong poses pass (tests/lib/test_outliers.cpp: 3 deg
  /// off).
  double agreement = 3;
  /// The same in each principal direction alone, of translation and of rotation
  /// (SelectionOptions::contradicts): shorter motions may have been refused for one of them.
  double contradicts = 4;
  /// Exception to all of the above: the residuals of one answer are this many times those of the other one.
  /// They are compared on the motions of the single stride, as the product of the mean squared residuals of
  /// rotations and of translations. The smaller it is, the more likely is the answer, whatever the two noises
  /// are. If the balance is wrong by a factor of a thousand, the minimum may be half a turn away, and a
  /// jack-knife reports a small standard deviation for it.
  /// Two: by eight independent motions, the fewest parts of a spread, it is 4,000 times less likely. Answers
  /// that are both near the truth differ by a few percent. Study: docs/weights.md, "Wrong minima".
  double less_likely = 2;
  /// The choice in force keeps its place unless another's sum of logarithms is smaller by this: settings do
  /// not flap.
  double hysteresis = 0.05;
  /// Spreads of long motions are corrected for noise that omitting blocks misses. How fast that noise grows
  /// must be shown by the residuals, by this many standard errors: no median, coverage or spread of the
  /// benchmark's levels changes (100 poses), and short simulated drives with noise on motions are covered in
  /// 97 % instead of 82. With three a mixture of noise on poses and on motions is covered in 87 %.
  double growth_evidence = 1;
  /// In the plane rotations have one axis instead of three, and tell a third as much: the smallest growth
  /// within one standard error is too often far too small. In 171 of 1200 drives of 100 motions with noise on
  /// poses and on motions, weights of too long a memory won, whose intervals covered 76 %. So the most likely
  /// growth is taken (docs/intervals.md, "In the plane, and very short drives"). In three dimensions that
  /// would cost accuracy: on the benchmark's poses with noise .010 the median is 0.24 instead of 0.19 deg.
  double growth_evidence_in_plane = 0;
  /// A spread needs at least this many blocks: five degrees of freedom, as
  /// ObservabilityOptions::least_blocks.
  std::size_t least_blocks = 6;
  ResidualWeightOptions residuals{};
};

/// The weights in force and why.
struct WeightChoice {
  StrideWeights weights;
  DualQuaternion q;          ///< their minimiser (planar mode: T_p)
  double memory = 0;         ///< of the chosen shape [steps]; 0: what the residuals suggest
  double mean_stride = 1;    ///< of the motions, weighted
  double ratio = 1;          ///< weight of rotation to that of translation, of all motions [m^2]
  bool beats_single = true;  ///< clearly smaller spread than the rival's
  std::string reason;
};

/// Motions of one stride alone, what the sum over strides is compared with.
struct SingleStride {
  int stride = 1;
  Balance balance;
  Problem problem;  ///< its motions without those that contradict the others, in disjoint blocks
};

/// Chooses the weights of the strides. For white noise on poses together with a random walk (noise on motions
/// that adds up) the maximum-likelihood weight of a motion of s steps is lambda^s. lambda depends on the
/// ratio of the two noises alone (0: neighbours only; 1: all alike). It is fitted to the variances of the
/// residuals by stride, for rotation and translation separately. Their balance is the inverse of these
/// variances. Another lambda = exp(-1 / memory) is taken if the jack-knife over poses shows a clearly smaller
/// spread with it: then the noise is of another kind, for example it drifts or grows with the length. sums:
/// of the blocks. problem: mode, planes and prior. current: the choice in force. rival: the best single
/// stride. It is not beaten if it is not among the strides of the blocks, or contradicts the sum, unless the
/// answer of the sum is far more likely on the rival's own motions. Empty if no motion turns or moves.
std::optional<WeightChoice> choose_weights(const StrideBlocks& blocks, const TouchingSums& sums,
                                           const Problem& problem, const std::optional<WeightChoice>& current,
                                           const std::optional<SingleStride>& rival = {},
                                           const WeightingOptions& options = {});

/// What the residuals suggest, without the jack-knife.
std::optional<WeightChoice> residual_weights(const StrideBlocks& blocks, Mode mode,
                                             const ResidualWeightOptions& options = {});

}  // namespace egocal
