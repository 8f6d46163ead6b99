// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mounting that changed by so much that neither part of the drive has an answer near that of the
// other one: a camera that was turned round, or poses in other axes from some time on. find_moves()
// linearises around the answer of the whole and sees changes of up to about 30 degrees.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// "Study" is tests/bench/mistake_study.cpp.
struct LargeMoveOptions {
  std::size_t places = 15;  ///< divisions of the drive that are tried, evenly; then every motion
  /// Independent parts of the drive (Motions::blocks) on either side: six unknowns are then known four times
  /// over.
  std::size_t least_blocks = 4;
  /// A side contradicts the other one's answer where its typical residual there is more than this part of the
  /// typical motion; noise of a tenth of every motion stays below 0.3.
  double contradicts = 0.3;
  /// The own answer of such a side must leave less than this part of that residual there, and contradict
  /// nothing by itself.
  double own = 0.4;
  /// Parts of the drive in which unexplained_part() looks for one run: a third of the drive is four of them.
  std::size_t windows = 12;
  /// Part of the drive that unexplained_part() finds, at least and at most: less may be a sharp turn or wrong
  /// poses, of more the answer is that of the other part.
  double least_part = 1.0 / 3, most_part = 2.0 / 3;
  /// Part of the typical motion: where the median motion of a window is smaller the sensors stand, and only
  /// wrong poses move. find_moves() ignores motions likewise (MovesOptions::least_motion).
  double least_motion = 0.1;
};

/// Finding mount_moved with the time and the answer after it; its improvement compares two answers with one.
/// stride: of the motions that the streams are compared by; a quarter of it is tried, too, as a part of the
/// drive has more of them.
std::optional<Finding> large_move(const Instants& instants, int stride, const DiagnosisOptions& options,
                                  const LargeMoveOptions& large = {});

/// A part of the drive, by default at least a third and at most two thirds, that the answer does not explain
/// while it explains the rest.
struct UnexplainedPart {
  double begin = 0, end = 0;  ///< [s]
};
std::optional<UnexplainedPart> unexplained_part(const Motions& motions, const DualQuaternion& T_a_b,
                                                const LargeMoveOptions& large = {});

}  // namespace egocal::detail
