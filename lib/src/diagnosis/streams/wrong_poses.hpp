// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Single wrong poses of a drive whose answer is known: the motions into and out of them contradict it, the
// motion past them does not.
#pragma once

#include <cstddef>

#include "diagnosis/motions/motions.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

struct WrongPosesOptions {
  std::size_t most = 20000;  ///< instants; a longer drive stays as it is, for time
  /// Instants in a row that are wrong: a wrong pose of the other stream bends the path beside two to four
  /// instants of the slower one, and the next may be wrong by itself.
  std::size_t most_in_a_row = 8;
  /// A motion agrees with the answer where its residual is at most `agree` times the median for its length,
  /// and contradicts the answer above `contradict` times that. Wrong poses spoil up to half of the motions;
  /// noise with heavy tails (Student, 3) exceeds `contradict` in two of a thousand steps.
  double agree = 6, contradict = 10, usual = 0.5;
  double rounding = 1e-9;  ///< residuals below are digits of files [rad, m]
  /// Part of the instants that is wrong. Fewer spoil no tenth of a drive, and may be what shows a mistake: 31
  /// of 2,240 on EuRoC with the inverse rotations of both streams. Of more it is not known which are right.
  double least_wrong = 0.04, most_wrong = 0.3;
};

/// The instants without the wrong ones. What goes on contradicting, as after a sensor was moved, stays.
/// Study: tests/lib/test_wrong_poses.cpp, and 40 drives of an independent simulator with wrong poses in a
/// twentieth of each stream: 26 were contradictory or doubtful without this, 3 are with it.
Instants without_wrong_poses(const Instants& instants, const Pose& T_a_b,
                             const WrongPosesOptions& options = {});

struct SpoiledPartOptions {
  double agree = 3;  ///< residuals of a motion that agrees, as multiples of the median ones of the rest
  /// Part of the way and the turning of the motions that agree nevertheless: wrong poses in a twentieth of
  /// each stream, one of which is interpolated, spoil a quarter of all motions and may spoil most of a tenth,
  /// never all.
  double most_agreeing = 0.15;
  std::size_t least = 5;  ///< motions of the part, not at rest: fewer may all be spoiled
  /// Motions in a row that do not agree. A tenth of the drives of the study has 16 to 18 motions; of 39 in a
  /// row, where rows were of another drive for 9 s, some at both ends of the part agreed.
  std::size_t most_in_a_row = 20;
};

/// Whether single wrong poses explain that the motions from begin to end [s] contradict the answer: some of
/// them agree with it as those of the rest do.
bool spoiled_by_wrong_poses(const Motions& motions, const Pose& T_a_b, double begin, double end,
                            const SpoiledPartOptions& options = {});

}  // namespace egocal::detail
