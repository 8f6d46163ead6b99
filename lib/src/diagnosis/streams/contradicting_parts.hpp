// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Parts of the drive that the answer of the others does not explain at all: where a mounting moves twice
// within seconds, neither place of a move is found.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct ContradictingPartsOptions {
  std::size_t parts = 10;  ///< of the drive, of equal duration
  /// Motions of a part that counts, none at rest. A wrong pose is the end of two of them: two wrong poses
  /// spoil most of 6 motions.
  std::size_t least = 20;
  /// A part counts where in at least this part of its motions neither sensor is at rest: of a vehicle that
  /// stands the other motions are those of wrong poses. Found on a car that stood for 7 s with 5 % wrong
  /// poses.
  double least_moving = 0.5;
  /// A part is judged by this quantile of the rotations that the answer leaves: three of four motions are off
  /// by more. 5 % wrong poses in both streams spoil the median of a tenth, as each also spoils those that are
  /// interpolated from it (2 of 36 short clean drives).
  double quantile = 0.25;
  /// A part contradicts if its quantile is this many times that of the median part, both in degrees and for
  /// each degree that is turned. Clean drives: 3.2 (116 of an independent simulator).
  double times = 10;
  /// And its quantile is at least this [rad]: as large as what users call wrong.
  double least_rotation = radians_per_degree;
  /// Motions of this part of the length leave so many times more for each degree, too: a single jump is in
  /// few of them.
  int shorter = 4;
  double times_of_shorter = 3;
  double least_turning = 0.1;  ///< less turning than this part of the usual one counts as so much
};

struct ContradictingPart {
  double begin = 0, end = 0;  ///< [s]
  double rotation = 0;        ///< the quantile of what the answer leaves [rad]
};
struct ContradictingParts {
  std::vector<ContradictingPart> parts;
  double others = 0;  ///< rotation that the answer leaves in the median part [rad]
};

ContradictingParts contradicting_parts(const Instants& instants, int stride, const Pose& T_a_b,
                                       const MotionSampleOptions& motions,
                                       const ContradictingPartsOptions& options = {});

/// Finding mount_moved, uncertain, where there are such parts.
std::optional<Finding> contradicting_parts_finding(const ContradictingParts& found);

}  // namespace egocal::detail
