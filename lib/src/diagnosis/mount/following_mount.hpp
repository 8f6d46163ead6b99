// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that follows what the sensors do: it is on a steered or sprung part, or has play and hangs to one
// side while they accelerate. The rotation between the sensors is then a function of how they turn and
// accelerate; noise is not, whatever its tails are.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/moves.md, "A mount that follows the motion".
struct FollowingOptions {
  std::size_t motions = 700;  ///< at most, evenly spread: a limit on time
  std::size_t least = 60;     ///< fewer do not show a relation of 36 numbers
  /// A motion that lasts longer than this many times the usual duration spans a gap: b is not measured there.
  double across_a_gap = 2;
  double window = 1.0 / 8;  ///< of a motion, on either side, in which turning and acceleration are measured
  /// Turning and acceleration count as a part of what they are beyond in a fifth of the drive, up to this
  /// many times it; and once more by their sign, which is open below `sign` of it.
  double usual = 0.8, largest = 3, sign = 0.3;
  double longest = 20;     ///< changes count up to this many times the median one: wrong poses
  std::size_t parts = 10;  ///< of the drive: each second one shows whether the relation of the others holds
  double penalty = 1e-3;   ///< on the relation, as a part of the mean square
  /// Part of the changes that the relation explains in parts it was not found in, at least. Mounts that
  /// follow: 0.34 to 0.82; 234 clean drives: below 0.2, or of_interpolation.
  double explained = 0.3;
  /// Least size of the change that the relation explains, which is smaller in 95 % of the time [rad]: as
  /// large as what users call wrong.
  double least_change = radians_per_degree;
  /// And that change is at least this many times what the better interpolation changes
  /// (SwayOptions::of_interpolation): a bicycle that leans faster than it is measured has 14, mounts 80 and
  /// more.
  double of_interpolation = 30;
};

struct Following {
  double explained = 0;  ///< part of the mean square of the changes of the rotation between the sensors
  double change = 0;     ///< that the relation explains; 95 % are smaller [rad]
};

/// How far the rotation between the sensors follows turning and acceleration, over motions of `steps`
/// instants, as either of them sees it: the noise of a pose is in what it says of both. The lesser. What
/// clocks that differ do is taken out before. Empty: too few motions.
std::optional<Following> following(const Instants& instants, const DualQuaternion& T_a_b, std::size_t steps,
                                   const FollowingOptions& options = {});

/// Finding mount_moved, uncertain: the rotations of one stream may do the same. stride: of the motions that
/// the streams are compared by.
std::optional<Finding> following_mount(const Instants& instants, int stride, const Answered& answered,
                                       const DiagnosisOptions& options);

}  // namespace egocal::detail
