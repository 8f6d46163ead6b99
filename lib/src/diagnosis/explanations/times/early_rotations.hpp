// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one stream that belong to other times than its positions, which few turns show. A sensor on a
// part that is steered turns by some seconds times the turning rate, so that its rotations look early by that
// time.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/times/two_times.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Rotations of another time".
struct EarlyRotationsOptions {
  TwoTimesOptions times;
  std::size_t least = 60;  ///< fewer do not show eight numbers and their scatter
  /// Least number of standard deviations of the time between rotations and positions, and of that between the
  /// rotations of both streams. Where it is the positions that have another time, LatePositions tells it
  /// better.
  double sigmas = 3.5;
  /// The positions have the time of the other stream, but for less than this part of the time of the
  /// rotations. That part is the clock's. Where the speed is constant the time of the positions is that of
  /// another lever arm, and noise on poses or a clock that differs leaves up to 11 standard deviations: of
  /// the time of the positions.
  double most_of_positions = 0.5;
  /// And two times make squared residuals smaller by this mean logarithm than one does. Steered and towed
  /// parts: 0.075 to 0.96; right streams whose positions have the time of the other one: 0.003.
  double least_gain = 0.05;
  double matters = 2;           ///< standard deviations of the answer by which it moves, at least
  double least_move = 1.0 / 6;  ///< of the tolerances: 10 cm (LateByARowOptions::least_change)
  double first_look = 2.0 / 3;  ///< of `sigmas` at which the other stream is looked at, too
};

/// Rotations of one stream that are early beside its positions.
struct EarlyRotations {
  Side side = Side::b;
  double seconds = 0;  ///< > 0: they are those of later times
  double stddev = 0;   ///< of it, by omitting parts of the drive [s]
  /// Time of the rotations alone against the other stream, and its standard deviation [s].
  double of_rotations = 0, of_rotations_stddev = 0;
  double gain = 0;  ///< mean logarithm of the squared residuals with one time over those with two
  /// The answers with two times, and without any.
  DualQuaternion T_a_b, T_a_b_as_given;

  double sigmas() const;
};

/// Early rotations of one stream by the motions as given: linear least squares of the extrinsic, of the time
/// of the rotations about the axis that the stream mostly turns about, and of the time of the positions.
/// Empty: too few motions.
std::optional<EarlyRotations> early_rotations(const Instants& instants, const Explained& given, Side side,
                                              const EarlyRotationsOptions& options = {});

/// Something else that rotations of another time may look like; a small offset of the clock is not.
bool explains_early(const Finding& finding, const DiagnosisOptions& options);

/// Names late_positions_a and _b, uncertain, and mount_moved, uncertain, where such rotations move the answer
/// by more than it states, and adds by how much to answered.timing_stddev and result.timing_stddev. The
/// blocks of the drive show nothing of that where a tenth of them has a turn, so it is asked for by the
/// standard deviation of the time. Nothing where something else explains the streams.
void name_early_rotations(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                          Diagnosis& result, const EarlyRotationsOptions& early = {});

}  // namespace egocal::detail
