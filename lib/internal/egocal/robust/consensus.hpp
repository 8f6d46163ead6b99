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

/// Truncated least squares over parts of a drive (single motions or runs of them): the extrinsic for which
/// the sum of min(residual, limit) is smallest. A single large residual then counts no more than any other,
/// and up to nearly half of the motion may be wrong, even if the wrong parts agree among themselves. Started
/// by graduated non-convexity (Geman-McClure weights that sharpen step by step, each step solved globally)
/// and from contiguous pieces of the drive and draws of them. Then runs that fit well enough, but would gain
/// far more than others by an extrinsic of their own, are left out as well. Nothing is judged against an
/// earlier answer, so motion that shows a new direction is never taken for an outlier. problem: mode, planes
/// and balance; its blocks are not looked at. overlap: so many consecutive motions of a part share time (the
/// stride), which makes them less independent. Empty where the parts are too few to outvote one another (16),
/// or do not move. Deterministic.
std::optional<Consensus> find_consensus(const Problem& problem, std::span<const Statistics> parts,
                                        int overlap = 1);

/// How far a part is from agreeing, as a multiple of the limit (squared): above 1 it is left out.
double disagreement(const Statistics& part, const Balance& balance, const Agreement& agreement);

}  // namespace egocal
