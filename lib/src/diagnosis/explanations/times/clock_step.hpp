// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A clock that was set in mid-drive. The motions before and after it then seem to have two mountings, as the
// sensors move on by the time that the clocks differ; but one mounting explains both on two clocks.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// "Study": steps of 0.05 to 2 s of either clock and knocked mounts in drives of docs/trust_measured.md.
struct ClockStepOptions {
  /// Divisions of the drive that are tried where no move of a mounting gives one, evenly. A part that holds a
  /// third of the other one still shows its own clock, as the fit is robust.
  std::size_t places = 3;
  /// Each part has this many motions, at least.
  std::size_t least_motions = 16;
  int rounds = 2;          ///< the time of the step and the clocks are found from each other
  double promising = 0.5;  ///< of DiagnosisOptions::gain: what a further round needs
  /// Two explanations whose mean log ratios of squared residuals differ by less cannot be told apart, and
  /// both are named: three times what chance makes of one number in the drives of the study.
  double alike = 0.15;
  /// Standard deviations of Wilcoxon's signed ranks, at least, of a gain of DiagnosisOptions::gain and more.
  /// A drive of 16 blocks, half of which are on another clock, shows 2.6. It is known already that something
  /// contradicts.
  double sigmas = 2;
  /// The step differs from zero by more than this part of the distance of two poses, and by more than
  /// ClockSearchOptions::least: less is within what interpolation leaves.
  double least_of_period = 0.1;
  /// A jump of the stamps is that of the step where it differs from it by less than this part of the distance
  /// of two poses.
  double same_jump = 0.5;
  /// A step is looked for where a tenth of the drive leaves this many times the rotation that the best
  /// quarter of the tenths leaves, and this much [rad]; this costs time alone, as the step must explain more.
  double contradicts = 4, least_contradiction = 0.005;
};

/// Finding clock_step with its time and size, where findings say that one explanation does not hold
/// for all of the drive: that the mount moved, the lengths or clocks change, or parts contradict; and where
/// tenths of the drive do (fit). The offset of each part with one mounting is compared with a mounting for
/// each part, and with what else was found. It replaces these where it explains clearly more, and stands
/// beside them, uncertain, where it explains as much. Not for planar answers.
void name_clock_step(const Evidence& evidence, const Fit& fit, const DiagnosisOptions& options,
                     std::vector<Finding>& findings, const ClockStepOptions& tuning = {});

}  // namespace egocal::detail
