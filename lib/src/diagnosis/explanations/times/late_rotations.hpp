// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/explanations/replacing.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes". 180 clean drives of the simulator and 78 of the public
/// benchmark, with the offset of their clocks estimated, stay below a gain of 0.01 at the first look and of
/// 0.03 at the clock of the rotations; rotations or positions of the row before, where they show at all,
/// begin at 0.026 and 0.125.
struct LateRotationsOptions {
  double first_gain = 0.02,
         first_sigmas = 2;  ///< of late positions on the clock in force: worth a second look
  double sigmas = 5;        ///< of the offset of the rotations from the clock in force
  double widest = 0.5;      ///< that offset at most [s]
};

/// The drive on another clock.
struct OnClock {
  Instants instants;
  Explained explained;  ///< no motions: none was found
};

/// The drive with another time offset [s]. max_gap: of interpolation [s].
OnClock on_clock(const Evidence& evidence, double offset, double max_gap, const DiagnosisOptions& options);

/// Where rotations alone are late, the clock that suits them is wrong for the positions: late_positions_a or
/// _b is added after a certain clock_offset, and both have the answer that suits both. An offset that was
/// estimated from both is a compromise, at which neither seems to be late by much: late_positions_a or _b is
/// then named at the clock of the rotations. Nothing is added beside other certain findings. max_gap: of
/// interpolation [s]. wrong: of the same evidence.
void name_late_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                         WrongStream& wrong, std::vector<Finding>& findings,
                         const LateRotationsOptions& late = {});

}  // namespace egocal::detail
