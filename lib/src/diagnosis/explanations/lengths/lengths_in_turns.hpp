// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lengths of one stream that are lost, or gained, while it turns: in all turns, or in those to one side.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/motions/mount_fit.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Scale".
struct LengthsInTurnsOptions {
  MountFitOptions fit;
  std::size_t least = 60;  ///< motions; fewer do not show eight numbers and their scatter
  /// Turning angles beyond this many times the usual one count as that: few motions turn by more.
  double most_turning = 3;
  /// Beyond this many times the usual angle only the side of a turn counts, where no more than that counts.
  double side_alone = 0.5;
  double seconds_to_a_side = 1;  ///< of a motion, at most, where the side of a turn counts
  double sigmas = 5;             ///< of what is lost at the usual turning
  /// Part of the lengths that is lost at the usual turning, at least. Right odometries differ by up to 1 %.
  double least_lost = 0.02;
  /// And lengths that change with the turning make squared residuals smaller by this mean logarithm than one
  /// scale does.
  double least_gain = 0.05;
  double least_move = 1.0 / 6;  ///< of the tolerances by which the answer moves: 10 cm, as where times differ
  /// Of turns to a side, where the residuals fall by less, which a nearly constant speed and noise on poses
  /// leave: standard deviations of the answer by which it moves, at least. In 117 clean drives of ten
  /// machines no lengths in turns to a side have more than 3.4 standard deviations.
  double matters = 2;
};

/// What the lengths change with.
enum class TurnsThatCount {
  all,      ///< the turning, to whatever side
  by_side,  ///< the turning about the axis that the sensors mostly turn about: more in turns to one side,
            ///< less in those to the other. At a constant speed that is a lever arm and has no trace
  side,     ///< the same by the side alone, however slow the turns are
};

struct LengthsInTurns {
  TurnsThatCount turns = TurnsThatCount::all;
  /// Part of the lengths of b, against those of a, that is lost at the usual turning (half of the turning is
  /// in motions that turn by more), < 0 where a loses; and the standard deviation of this part, by omitting
  /// parts of the drive. Of turns to a side the sign says nothing: either end of the axis may be up.
  double lost = 0, stddev = 0;
  double straight_on = 1;  ///< factor of b's lengths while nothing turns
  double gain = 0;         ///< mean logarithm of the squared residuals with one scale over those with both
  DualQuaternion T_a_b;    ///< with both
  DualQuaternion T_a_b_as_given;  ///< with neither
  double sigmas() const;
};

/// Linear least squares of the extrinsic, of a scale of b, and of a scale that grows with the turning. Noise
/// of one stream makes its own lengths seem too long, the more the less it moves: so the lengths of each
/// stream are asked, and the one that says less counts. Empty: too few motions.
std::optional<LengthsInTurns> lengths_in_turns(const Explained& given, TurnsThatCount turns,
                                               const LengthsInTurnsOptions& options = {});

/// Names scale_change in place of a scale where lengths are lost in turns, and the answer is another one
/// then; of the turns that count those that explain most. Uncertain where turns to a side explain little;
/// then the change of the answer, which is not known, is returned, else 0. Nothing where something else
/// explains the streams.
Vector6d name_lengths_in_turns(const Evidence& evidence, const Answered& answered,
                               const DiagnosisOptions& options, std::vector<Finding>& findings,
                               const LengthsInTurnsOptions& tuning = {});

}  // namespace egocal::detail
