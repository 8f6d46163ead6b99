// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths of the streams that differ by no more than those of right odometries do.
#pragma once

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// When a scale that the motions do not exclude counts. How surely it is another one, and what right
/// odometries differ by, are ScaleCheckOptions::sigmas and ::least. Study:
/// docs/trust_measured.md, independent simulators.
struct SmallScaleOptions {
  /// Standard deviations of the answer by which it moves, at least (ClockCheckOptions::matters): less is
  /// within what it states.
  double matters = 2;
  /// Standard deviations from one of a scale that is no larger than right odometries differ by
  /// (ScaleCheckOptions::least); one that is larger needs ScaleCheckOptions::sigmas, as right ones seldom
  /// have it. Of 92 clean drives of an independent simulator six have about 3 and more, whose
  /// odometries do wander, and none of these has the finding.
  double significant = 3;
  /// It moves the answer by at least this part of the tolerances, 3 cm or 0.05 deg. With precise streams half
  /// a centimetre is more than the answer states, and no user's concern.
  double least_move = 0.05;
  /// A motion whose squared residual is more than this many times the median one is omitted: five standard
  /// deviations (DriveScaleOptions::most_residual).
  double most_residual = 25;
  /// A jack-knife needs at least this many blocks (ScaleOptions::least_blocks).
  std::size_t least_blocks = 6;
};

/// An answer is that of lengths that are right. A multirotor tilts as it accelerates, so a hundredth of them
/// may look like a metre of lever arm, which no standard deviation contains. Names the scale of b, uncertain,
/// and adds what it leaves unknown to answered.timing_stddev and result.timing_stddev, where the scale
/// differs from one by many of its standard deviations, or one that is not excluded moves the answer by more
/// than the tolerance; and where the answer does not state as much. Nothing where something else explains the
/// streams, or the scale was estimated. A millisecond.
void name_small_scale(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                      Diagnosis& result, const SmallScaleOptions& small = {});

}  // namespace egocal::detail
