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

/// Study: docs/trust_rules.md, "Rotations of another time". Of 45 clean drives of 14 machines the largest
/// number of standard deviations is 2.6, of the real ones 3.0; of eight trams with a sensor on a bogie 3.9
/// to 14.
struct EarlyRotationsOptions {
  TwoTimesOptions times;
  std::size_t least = 60;  ///< fewer do not show eight numbers and their scatter
  /// Of the time between rotations and positions, and of the rotations from those of the other stream: where
  /// it is the positions that have another time, LatePositions tells it better.
  double sigmas = 3.5;
  /// A part of the time that both the rotations and the positions are off by is that of the clock: the rest
  /// is at least this part of the time of the rotations.
  double least_part = 0.5;
  double matters = 2;           ///< standard deviations of the answer by which it moves, at least
  double least_move = 1.0 / 6;  ///< of the tolerances: 10 cm (LateByARowOptions::least_change)
  double first_look = 2.0 / 3;  ///< of `sigmas` at which the other stream is looked at, too
};

/// Rotations of one stream that are early beside its positions.
struct EarlyRotations {
  Side side = Side::b;
  double seconds = 0;  ///< > 0: they are those of later times
  double stddev = 0;   ///< of it, by omitting parts of the drive [s]
  /// The same of the rotations alone, against the other stream [s].
  double of_rotations = 0, of_rotations_stddev = 0;
  double gain = 0;  ///< mean logarithm of the squared residuals with one time over those with two
  /// The answers with two times, and without any.
  DualQuaternion T_a_b, T_a_b_as_given;

  double sigmas() const;
};

/// By the motions as given. Linear least squares of the extrinsic, of the time of the rotations about the
/// axis that the stream mostly turns about, and of the time of the positions. Empty: too few motions.
std::optional<EarlyRotations> early_rotations(const Instants& instants, const Explained& given, Side side,
                                              const EarlyRotationsOptions& options = {});

/// Names late_positions_a and _b, uncertain, and mount_moved, uncertain, where such rotations move the answer
/// by more than it states, and adds by how much to answered.timing_stddev and result.timing_stddev. The
/// blocks of the drive show nothing of that where a tenth of them has a turn, so it is asked for by the
/// standard deviation of the time. Nothing where something else explains the streams.
void name_early_rotations(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                          Diagnosis& result, const EarlyRotationsOptions& early = {});

}  // namespace egocal::detail
