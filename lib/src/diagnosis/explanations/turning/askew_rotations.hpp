// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one stream that are systematically wrong: a gyroscope whose axes are askew or not at right
// angles turns the same way about other axes in all of the drive. Each part of the drive then has the same
// answer, and noise hides what the single motions leave.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes".
struct AskewOptions {
  std::size_t motions = 240;  ///< of each length, evenly spread: a limit on time
  int shorter = 3;            ///< motions are a third as long the second time; three steps where they are one
  /// Parts of the drive whose own estimates show what is chance; fewer than `least_parts` show nothing.
  std::size_t parts = 24, least_parts = 8;
  double motions_a_part = 6, parts_a_motion = 0.5;  ///< at least, at most: parts are to be independent
  double inlier = 9;  ///< squared residuals count up to this many times the median one
  /// Chance that noise shows as much in one direction (F over the parts): a finding. Of 400 clean drives of
  /// two independent simulators two reach 1e-5, none 1e-6; axes askew by 1 to 4 deg reach 1e-6 to 1e-30.
  double chance = 1e-6;
  /// Motions of the other length show this part of the same turn, at least: errors of interpolation grow as
  /// motions become shorter.
  double part_of_other = 0.5;
  /// Least turn, as a part of the tolerance: the answer lies between what the two halves of a stream say, so
  /// it may be off by more.
  double least = 0.5;
  double tolerance = radians_per_degree;  ///< [rad]; DiagnosisOptions::tolerance_rotation
};

/// A turn that is larger than chance explains.
struct Askew {
  enum class Kind {
    against_positions,  ///< the mounting that the rotations show, against the one that the positions show
    world_a,            ///< positions of a stream, against its rotations, in its world
    world_b,
    of_rates,  ///< the mounting, where rotation rates of one stream may be any symmetric map of right ones
  };
  Kind kind = Kind::against_positions;
  double turn = 0;    ///< [rad]
  double chance = 1;  ///< that noise shows it
};

/// The surest of these turns, in motions of `stride` instants and of another length; empty where none is sure
/// or large enough.
std::optional<Askew> askew(const Instants& instants, int stride, const DualQuaternion& T_a_b,
                           const MotionSampleOptions& motions, const AskewOptions& options = {});

/// Finding odometry, uncertain: odometries that drift in one direction all the time have the same turns, and
/// their answers may be right. So it does not change the verdict. Which of the two streams is wrong is open.
std::optional<Finding> askew_rotations(const Instants& instants, int stride, const Answered& answered,
                                       const DiagnosisOptions& options);

}  // namespace egocal::detail
