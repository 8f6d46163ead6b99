// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// What "fits" means, learnt from the data: noise may be the same for every motion, or grow with it.
struct ResidualScale {
  double absolute = 0;  ///< typical mean squared residual of a part (16)
  double relative = 0;  ///< typical ratio of it to the mean squared size of the part's motions
};

/// What the parts that agree agree on.
struct Agreement {
  DualQuaternion q;  ///< minimiser of (18) over them (planar mode: T_p)
  ResidualScale scale;
};

/// Which parts of a drive agree on one extrinsic.
struct Consensus {
  Agreement agreement;
  std::vector<bool> outlier;  ///< per part
};

/// Tuning of find_consensus(). Study: tests/bench/outlier_study.cpp, its table in docs/accuracy.md, "Gross
/// outliers".
struct ConsensusOptions {
  std::size_t least_parts = 16;  ///< fewer parts cannot outvote one another
  /// A part is an outlier when its mean squared residual is this many times the typical one, by both scales.
  /// Real odometry has heavy tails that belong to it; what is grossly wrong is wrong by the size of the
  /// motion. The mean of many motions is steadier than one: limit_of_many + (limit_of_one - limit_of_many) /
  /// motions.
  double limit_of_many = 6, limit_of_one = 200;
  /// Least relative residual (squared): nothing better than a hundredth of the motion is expected of
  /// odometry.
  double least_relative = 1e-4;
  /// Residuals smaller than this part of the motion are rounding: nine digits of a quaternion.
  double rounding = 1e-9;
  /// Starting points besides the contiguous ones (see fit_draws()), and how many of all are followed to their
  /// end. Of 32 draws of four parts one is free of outliers with a probability of more than 99.9 % where 30 %
  /// of the parts are wrong.
  std::size_t draws_of_pieces = 16, draws_of_parts = 32, most_settled = 8;
  /// A fit to three hundredths of the motion (squared) with parts no further off than `unsuspicious` needs no
  /// further search: limit_of_many.
  double good_fit = 1e-3, unsuspicious = 6;
  /// A run of motions may fit well enough and yet come from another extrinsic (two axes exchanged on a
  /// straight road): then it would gain far more than others by an extrinsic of its own. Of single runs of
  /// real drives up to 25 times the typical gain, all others below 10; of such a stretch 10 to 60.
  double most_gain = 10;
  double least_run = 16;  ///< shorter runs of independent motions fit anything by themselves
  /// A smaller typical gain is nothing to compare with [squared residuals of one motion].
  double least_gain = 1;
  /// This part of the motion must agree. The scale is doubled until it does, at most most_relaxed times: 256
  /// times the tightest fit is no fit.
  double majority = 0.55;
  int most_relaxed = 8;
  /// For that no part counts as if its motions were larger than this many times the typical squared size:
  /// three times as long. Poses that are wrong by ten steps make motions of a hundred times, and one that was
  /// not recognised in each 30 s is half of what a truck drives in a yard.
  double most_size = 9;
};

/// Truncated least squares over parts of a drive (single motions or runs of them): the extrinsic for which
/// the sum of min(residual, limit) is smallest. A single large residual then counts no more than any other,
/// and up to nearly half of the motion may be wrong, even if the wrong parts agree among themselves. Started
/// by graduated non-convexity (Geman-McClure weights that sharpen step by step, each step solved globally)
/// and from contiguous pieces of the drive and draws of them. Then runs that fit well enough, but would gain
/// far more than others by an extrinsic of their own, are outliers as well. Nothing is judged against an
/// earlier answer, so motion that shows a new direction is never taken for an outlier. problem: mode, planes
/// and balance; its blocks are not looked at. overlap: number of consecutive motions of a part that share
/// time (the stride), which makes them less independent. Empty where the parts are too few to outvote one
/// another, or do not move. Deterministic.
std::optional<Consensus> find_consensus(const Problem& problem, std::span<const Statistics> parts,
                                        int overlap = 1, const ConsensusOptions& options = {});

/// How far a part is from agreeing, as a multiple of the limit (squared): above 1 it is an outlier.
double disagreement(const Statistics& part, const Balance& balance, const Agreement& agreement,
                    const ConsensusOptions& options = {});

}  // namespace egocal
