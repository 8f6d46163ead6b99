// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What looks like a mount that moved and is an odometry that is corrected, as where a loop is closed: its
// poses are drawn to where they belong for some seconds, and the mounting is the same before and after.
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/moves/find_moves.hpp"

namespace egocal::detail {

struct CorrectionOptions {
  /// Time that is omitted on both sides of a change [s]: SLAM systems spread a correction over as long. A
  /// side on which less time remains shows too little.
  double seconds = 5;
  /// Without these seconds the motions must show the change with a chance below this: at one place, as
  /// MovesOptions::confirmation.
  double chance = 1e-2;
  /// No mounting explains a stretch whose typical squared residual at its own answer is this many times that
  /// of another one, and as many times in parts of the motions: they would be outliers there
  /// (RobustFitOptions::inlier).
  double unexplained = 9;
};

/// A part of a drive, and its answer.
struct Stretch {
  Motions motions;
  DualQuaternion T_a_b;
};

/// Whether no mounting explains the motions of x as those of y are explained.
bool unexplained_beside(const Stretch& x, const Stretch& y, const CorrectionOptions& options = {});

/// The moves that are none: the motions before and after agree without the seconds around; or, where too few
/// seconds are left to tell, no mounting explains the motions on one side or between neighbours. Bumps, not
/// creep. pairs: that showed the moves, whose times are counted from the first one.
std::vector<Move> without_corrections(const std::vector<MotionPair>& pairs, const Problem& problem,
                                      std::vector<Move> moves, const CorrectionOptions& options = {});

}  // namespace egocal::detail
