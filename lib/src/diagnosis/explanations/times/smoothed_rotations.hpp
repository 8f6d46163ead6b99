// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one stream that a filter smooths, and so delays, while its positions may be on time. The clock
// that suits the rotations is then wrong for the positions, and at a steady speed that is a longer lever arm:
// all motions agree with a wrong answer.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/times/two_times.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Rotations that are smoothed".
struct SmoothedRotationsOptions {
  TwoTimesOptions times;
  MountFitOptions fit;
  std::size_t least = 60;           ///< motions; fewer do not show five numbers and their scatter
  double least_span = 0.2;          ///< rates are measured over at least this time [s]
  std::size_t most_instants = 100;  ///< and over at most this many instants on each side
  /// The variance of the delay is at least this many of its standard deviations. That of a clock is zero. In
  /// 200 clean drives of 25 machines one has 9.9 (with a gain of 0.02), and all others have less than 6;
  /// filters of 0.1 to 0.4 s on a tractor have 19 to 111.
  double sigmas = 8;
  /// Squared residuals of the rotations are smaller by this mean logarithm with it: 0.17 to 1.2 there, at
  /// most 0.02 in clean drives with a positive variance.
  double least_gain = 0.1;
  /// Beside a certain clock_offset, which the width must suit, it is enough that the parts of the drive agree
  /// on it (MountFit::agreement): without a filter by a chance of at most exp(-4^2 / 2), 0.03 %, however
  /// uneven the parts are. Noise in its own stream takes gain away, and drifting noise leaves that agreement;
  /// white noise on its poses hides both. Of 14 such filters 12 have 4.1 to 4.8; in 174 clean drives with a
  /// clock the six of a width that suits have at most 2.3.
  double agreement = 4;
  double matters_by_agreement = 4;  ///< standard deviations of the answer by which it moves then, at least
  /// The root of that variance over the delay: 1 of a filter of the first order, 0.58 of a mean of the last
  /// rows, 0 of a clock.
  double least_width = 0.4, most_width = 2.5;
  /// Positions that are nearer than this many of their standard deviations to the time of the rotations, and
  /// not to the other one, are smoothed as well. A time that is neither is of the filter: it is not linear.
  double positions_sigmas = 4;
  double matters = 2;            ///< standard deviations of the answer by which it moves, at least
  double least_move = 1.0 / 12;  ///< of the tolerances: 5 cm
};

/// How a filter delays the rotations of a stream.
struct SmoothedRotations {
  Side side = Side::b;
  double delay = 0;                          ///< more than that of the clock [s]
  double variance = 0, variance_stddev = 0;  ///< of the delay: of the filter's response [s^2]
  double agreement = 0;                      ///< of the parts of the drive that it is more than zero
  double gain = 0;                           ///< mean logarithm of the squared residuals by the variance

  double sigmas() const;
  /// Root of the variance [s]; 0 where that is not positive.
  double width() const;
};

/// The delay of a stream's rotations and its variance, beside a turn of the mounting. Rates are measured in
/// that stream alone: noise of the other one cannot look like smoothing then, and its own looks like the
/// contrary. Empty: too few motions.
std::optional<SmoothedRotations> smoothed_rotations(const Instants& instants, const Explained& given,
                                                    Side side, const SmoothedRotationsOptions& options = {});

/// Names late_positions_a or _b, uncertain, where the rotations of one stream are smoothed and its positions
/// do not show which time is theirs. Beside a certain clock_offset that is the delay of the filter; without
/// one it may be in the clock already, so that the width of the filter tells its delay. By how much the
/// answer moves is added to answered.timing_stddev and result.timing_stddev. max_gap: of interpolation [s].
void name_smoothed_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                             Answered& answered, Diagnosis& result,
                             const SmoothedRotationsOptions& smoothed = {});

}  // namespace egocal::detail
