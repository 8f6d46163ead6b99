// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Turning about one axis that is later in one stream than in the other, while about the other axes it is not:
// a sensor on a part that is towed or steered, or a filter that delays a heading. At one speed such a stream
// fits as well with a shorter lever arm, so that all motions agree with a wrong answer.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/times/two_times.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "Turning about one axis that is late".
struct LateTurningOptions {
  TwoTimesOptions times;
  std::size_t least = 60;  ///< motions; fewer do not show five numbers and their scatter
  /// The axes are found from the turning over this many consecutive motions. Shaking adds up to little there.
  std::size_t in_a_row = 8;
  std::size_t places = 100;  ///< of the drive, at which that turning is measured
  /// Standard deviations of the time about the axis from zero, and from the time about the other axes.
  double sigmas = 6, sigmas_apart = 4;
  /// The time about the other axes is at most this part of it: a clock that differs has one time about all.
  double most_of_others = 0.5;
  /// Squared residuals of the rotations are smaller by this mean logarithm with it.
  double least_gain = 0.02;
  double matters = 2;           ///< standard deviations of the answer by which it moves, at least
  double least_move = 1.0 / 6;  ///< of the tolerances: 10 cm (EarlyRotationsOptions::least_move)
};

/// Turning of one stream about an axis that is late.
struct LateTurning {
  Side side = Side::b;  ///< the stream that is late
  double seconds = 0, stddev = 0;
  double others = 0;        ///< by which it is late about the other axes [s]
  double apart_stddev = 0;  ///< of the difference [s]
  double gain = 0;          ///< mean logarithm of the squared residuals of the rotations
  /// The answers with rotations about the axis that are late beside the positions, and with none.
  DualQuaternion T_a_b, T_a_b_as_given;

  double sigmas() const;
};

/// Late turning by the motions as given, about the axis that shows it most. Empty: too few motions, or no
/// axis shows it.
std::optional<LateTurning> late_turning(const Instants& instants, const Explained& given,
                                        const LateTurningOptions& options = {});

/// Names mount_moved, uncertain, where that moves the answer by more than it states, and adds by how much to
/// answered.timing_stddev and result.timing_stddev: which of the answers is right the motions do not show.
/// Nothing where something else explains the streams.
void name_late_turning(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                       Diagnosis& result, const LateTurningOptions& late = {});

}  // namespace egocal::detail
