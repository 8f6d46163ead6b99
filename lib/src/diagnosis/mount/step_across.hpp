// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Where a mount moved, the motion from just before to just after it leads from the one extrinsic to the
// other. find_moves() compares the motions before with those after, which noise that wanders for seconds, a
// map that is bent or a correction makes differ as well; but the motions across its time then lead from the
// extrinsic to itself.
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/moves/find_moves.hpp"

namespace egocal::detail {

struct StepOptions {
  double slides = 5;  ///< a mount may slide for this long before and after the time of its move [s]
  double shown = 3;   ///< standard deviations of a component of the change that is looked at
  /// Motions that show how much is noise, at least and about at most: a limit on time.
  std::size_t least = 8, most = 200;
  /// The part of the change that shows across its time is this at most where the mount did not move. Of 80
  /// simulated moves those that are one have 0.8 to 1.1 where the noise of the part is small.
  double still = 0.5;
  /// A step that is another one than the change and longer than this part of it is no sign of a mount that
  /// stands still: the odometry began anew.
  double of_change = 0.75;
  /// Chance of a move that is believed although noise may hide it, at most. Of 1,020 clean drives of two
  /// simulators those that had a move had 3e-12 and more.
  double evident = 1e-12;
  double known = 0.25;  ///< standard deviation of the part, at most, where a mount is said to stand still
  double known_step = 0.33;  ///< and where a step is said to show: three of them
};

/// Whether the motions across the time of a move show its change.
enum class StepShown {
  yes,          ///< or another step
  slowly,       ///< not at its time, but with the seconds before and after it
  elsewhere,    ///< not at its time, but at another one: noise that wanders may have misplaced the move
  unknown,      ///< the noise is as large as the change, or too few motions are beside it
  not_at_once,  ///< not at its time; with the seconds around it unknown
  no
};
StepShown step_across(const Instants& instants, const PoseReading& reading, const Move& move, double begin,
                      const MotionSampleOptions& motions, const StepOptions& options = {});

}  // namespace egocal::detail
