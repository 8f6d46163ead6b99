// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths of one stream that are lost, or gained, while it turns.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/motions/mount_fit.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Scale".
struct LengthsInTurnsOptions {
  MountFitOptions fit;
  std::size_t least = 60;  ///< motions; fewer do not show eight numbers and their scatter
  /// Turning angles beyond this many times the usual one count as that: few motions turn by more.
  double most_turning = 3;
  double sigmas = 5;  ///< of what is lost at the usual turning
  /// Part of the lengths that is lost at the usual turning, at least. Right odometries differ by up to 1 %.
  double least_lost = 0.02;
  /// And lengths that change with the turning make squared residuals smaller by this mean logarithm than one
  /// scale does.
  double least_gain = 0.05;
  double least_move = 1.0 / 6;  ///< of the tolerances by which the answer moves: 10 cm, as where times differ
};

struct LengthsInTurns {
  /// Part of the lengths of b, against those of a, that is lost at the usual turning (half of the turning is
  /// in motions that turn by more), < 0 where a loses; and the standard deviation of this part, by omitting
  /// parts of the drive.
  double lost = 0, stddev = 0;
  double straight_on = 1;  ///< factor of b's lengths while nothing turns
  double gain = 0;         ///< mean logarithm of the squared residuals with one scale over those with both
  DualQuaternion T_a_b;    ///< with both
  double sigmas() const;
};

/// Linear least squares of the extrinsic, of a scale of b, and of a scale that grows with the turning. Noise
/// of one stream makes its own lengths seem too long, the more the less it moves: so the lengths of each
/// stream are asked, and the one that says less counts. Empty: too few motions.
std::optional<LengthsInTurns> lengths_in_turns(const Explained& given,
                                               const LengthsInTurnsOptions& options = {});

/// Names scale_change in place of a scale where lengths are lost in turns, and the answer is another one
/// then. Nothing where something else explains the streams.
void name_lengths_in_turns(const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, std::vector<Finding>& findings,
                           const LengthsInTurnsOptions& tuning = {});

}  // namespace egocal::detail
