// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "egocal/degrees.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// Tuning of the test of one division (docs/moves.md, "The test").
struct ChangeTestOptions {
  /// Residuals of blocks that are longer than this many medians count as if they were this long: one wrong
  /// block is not a change.
  double longest_residual = 3;
  /// Half of a side's blocks or more are so long: they are believed where the median of their costs at
  /// the side's own optimum is at most this part of that at the other side's, without linearising. Of eight
  /// mounts that turned by 3 to 5 deg in little noise the same moves are found with 0.05 to 0.3; with 0.5 an
  /// aircraft whose translations err by 20 m shows one of chance 1e-116.
  double own_part = 0.2;
  /// Curvature that one side lacks is taken from the whole, this part of it: without any, its own optimum is
  /// not defined, and with a millionth a stretch of straight driving was taken for a turn by 135 deg. The
  /// shortest side has thirty times as much where it shows anything.
  double borrowed_curvature = 1e-3;
  /// The noise in a block's gradient is that of its own motions, to this part, and otherwise has the shape of
  /// its curvature: of few motions the shape is uncertain, which hides changes. And it has this part of the
  /// mean noise of all, as motions can agree by chance. Study: docs/moves.md, "The test".
  double own_noise = 0.3, raised_noise = 0.03;
  /// Noise is assumed in directions that a block does not show, too: this part of the mean curvature.
  double raised_curvature = 0.01;
  /// A pair that fits this many times worse than the median of its block is rejected: ten standard
  /// deviations, beyond the tails of odometry and below the jumps that matter.
  double most_residual = 100;
  /// Degrees of freedom of the covariance, for each block, with its small eigenvalues raised to their mean.
  /// Over 20 to 64 blocks and four shapes of noise the tail of T^2 is below that of Hotelling's with 2.5,
  /// to chances of 2e-5 (docs/moves.md, "The test").
  double freedom = 2.5;
  /// Correlation from one block to the next, beyond the first, that the residuals are believed to have at
  /// most: noise that is remembered for ten blocks and more looks like a change.
  double longest_memory = 0.9;
  /// Chance of an even change above which it is not compared with steps: that takes time, and what is not
  /// reported need not be named.
  double even_looked_at = 1e-3;
  /// A part that differs from the rest is looked for between this many places first, and moved block by block
  /// from there: with all of 128 blocks it takes ten times as long and finds the same.
  std::size_t ends_looked_at = 32;
};

struct MovesOptions {
  /// Stated chance of a false alarm in one drive; the real one is about a tenth of it (MountCheckOptions,
  /// docs/moves.md).
  double false_alarms = 2e-3;
  /// A change is reported where one of its components exceeds this by two standard deviations: odometry has
  /// systematic errors nearly as large that depend on where and how the vehicle drives (0.11 deg between two
  /// lidar odometries on KITTI 07, docs/moves.md).
  double least_rotation = 0.15 * radians_per_degree;  ///< [rad]
  double least_translation = 0.01;                    ///< [m]
  /// Blocks that a stretch of the drive is divided into; the test's work grows with their square. A change
  /// between two ends of a block is found a little later: of bumps 15 s before the end of 135 s 35 of 40 are
  /// found with 64 blocks, 38 with 128.
  std::size_t most_blocks = 128;
  /// Fewer blocks say too little about the noise between them. Eight more than the parameters of two
  /// extrinsics.
  std::size_t least_blocks = 20;
  /// A pair in whose time the vehicle moves has at least this part of the drive's root mean square turn or
  /// way. Others are ignored: a vehicle that waits for half of its time at lights looked moved in most
  /// drives.
  double least_motion = 0.1;
  /// Pairs of one block, and at least three motions that share no time. As few as `least_block_pairs` in a
  /// drive that is too short for the least number of blocks otherwise; noise that wanders makes such blocks
  /// alike, so the chance of a false alarm must be smaller by `of_short_blocks`. Study: docs/moves.md,
  /// "Limits".
  std::size_t block_pairs = 8, least_block_pairs = 4;
  double of_short_blocks = 1e-4;
  /// Largest ratio of the variance of sums of blocks to that of sums of independent blocks. Where the ratio
  /// is larger, the noise wanders for longer than a block, and what was found must show in blocks twice as
  /// long, until the ratio is small enough, with the chance of a false alarm at this one place. Where it is
  /// still larger in the longest blocks, the change is certain only where that chance is smaller by
  /// of_short_blocks, too: of 180 still drives of 30 and 60 s whose errors are remembered for 3 and 6 s, 25
  /// had a certain change without this rule, 6 with it. Study: docs/moves.md; of 650 drives of 100 s, two had
  /// a false alarm at 1.4, one at 1.2, three without the limit.
  double most_correlation = 1.2;
  std::size_t least_side_blocks = 2;  ///< blocks before and after a change
  /// Least part of the stretch before and after a change, as well: a few of many short blocks at its end are
  /// soon wrong by chance where the noise has heavy tails.
  double least_side = 1.0 / 32;
  /// A mount that moves and falls back is looked for where nothing else is found, with this part of the
  /// chance of a false alarm: the sum hardly grows, and the evidence is hardly ever near it.
  double of_falling_back = 0.1;
  /// A mount that falls back was displaced for at least this part of the stretch. An odometry that errs in
  /// one place, as two lidars do for 13 of KITTI 05's 276 s, looks like a mount that moved there. Study:
  /// docs/moves.md, "Falling back".
  double least_displaced = 0.1;
  /// The parts before and after the displacement agree, or differ by less than this part of the change: less
  /// is left of two moves than each of them is.
  double most_left = 0.5;
  /// Noise of the rotations as a part of how far motions turn, at most: a shorter stride with more of it only
  /// confirms what longer ones show. The test is linear, and noise of poses, which the motions on either side
  /// of a pose share, pulls the extrinsic of slow and of fast parts differently. Noise of 0.1 to 1 degree on
  /// the poses of 84 clean drives: chances below 1e-6 from 0.22 on, none below 0.005 at less than 0.15.
  double most_noise = 0.15;
  std::size_t most_moves = 16;  ///< a limit on time
  /// Chance of what the motions of the other strides show at the time of a move, at most. EuRoC's drone at
  /// rest before its landing looks moved to single steps alone (tests/lib/test_moves.cpp).
  double confirmation = 1e-2;
  /// A pair's residual counts up to this many medians where the time of a change is looked for: five standard
  /// deviations.
  double place_residual = 25;
  /// The change is looked for where the cost of both answers together is within this of its least, in units
  /// of the noise of one parameter: three standard deviations.
  double time_interval = 9;
  /// A turn by more than this [rad] must show motion by motion: those of either side fit the other side's
  /// answer worse than their own by this factor, in the root mean square without the tails. The test of
  /// blocks is linear, and noise that wanders turns the answer of the last seconds by any angle. Study:
  /// docs/moves.md, "Limits".
  double large_turn = 20 * radians_per_degree, large_turn_contradicts = 2.5;
  ChangeTestOptions test;
};

enum class MoveKind {
  bump,   ///< at one time
  creep,  ///< evenly, all through the stretch between its neighbours
};

/// One change of the extrinsic during the drive.
struct Move {
  MoveKind kind = MoveKind::bump;
  double time = 0;      ///< [s] from the begin of the first motion pair; of a creep: its begin
  double earliest = 0;  ///< the change happened between these two, with about three standard deviations
  double latest = 0;    ///< [s]; of a creep: its end
  DualQuaternion before, after;    ///< T_a_b on both sides of it
  std::array<double, 6> change{};  ///< x y z roll pitch yaw in sensor a's frame, after minus before [m, rad]
  std::array<double, 6> stddev{};  ///< of the change [m, rad]; infinite where the motions do not show it
  double false_alarm = 1;          ///< chance of such evidence in a drive without a change
  bool certain = true;             ///< false: noise that wanders for as long may have made it
};

/// Lengths of what the motions show of a change: of the components that exceed three of their standard
/// deviations. Shortly after a change these are few, and the others are of any size.
struct ShownChange {
  double turn = 0;   ///< [rad]
  double shift = 0;  ///< [m]
};
ShownChange shown_change(const Move& move);

/// Whether the second one of two bumps leads back to the extrinsic before the first one, as far as the
/// motions show.
bool falls_back(const Move& moved, const Move& back);

/// The drive in stretches of one extrinsic each.
struct MovesResult {
  bool tested = false;      ///< false: too few motion pairs, nothing is known
  std::vector<Move> moves;  ///< in the order of time
  std::size_t stride = 0;   ///< of find_moves_of_strides(): index of the motions that show most
  /// Chance of the strongest evidence, reported or not, in a drive without a change. find_moves_of_strides():
  /// of what the motions of a second stride show as well, where there is one.
  double chance = 1;
};

/// Whether and when the mount between two sensors moved. pairs: consecutive motion pairs of one drive, in the
/// order of time, with poses that are not screw congruent already rejected (MotionPairing's are; in planar
/// mode as seen from the planes). problem: mode, planes and balance; its blocks are not looked at. A pose
/// that jumps (relocalisation) is a wrong motion, not a change: single motions and blocks carry little
/// weight. Deterministic. Throws nothing; without motion nothing is found.
MovesResult find_moves(std::span<const MotionPair> pairs, const Problem& problem,
                       const MovesOptions& options = {});

/// The same with the motions of one drive in several strides: noise that grows with time is distinguished
/// best by short ones, noise that does not by long ones. The stride whose strongest change is the least
/// likely by chance answers; the rate of false alarms is shared.
MovesResult find_moves_of_strides(std::span<const std::vector<MotionPair>> strides, const Problem& problem,
                                  const MovesOptions& options = {});

/// Chance of what the motions show of a change at this time, or of an even one all through them, where
/// nothing changes; for one time that was not searched for. Empty where there are too few motions.
std::optional<double> chance_of_move(std::span<const MotionPair> pairs, const Problem& problem, MoveKind kind,
                                     std::int64_t time_us, const MovesOptions& options = {});

}  // namespace egocal
