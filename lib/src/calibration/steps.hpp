// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What every way to an answer does: solve, ask the diagnosis, judge.
#pragma once

#include <optional>

#include "egocal/calibrate.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

Calibration solved(Problem problem, Choice choice, const PairingCounts& counts, Method method);

/// What the diagnosis is asked. single: motions of one stride, which it takes apart.
Answered answered(const Calibration& calibration, Problem single,
                  const std::optional<ScaleSolution>& scale = std::nullopt);

/// The calibration with the diagnosis, and with what the times add to the standard deviations.
Calibration judged(Calibration calibration, Diagnosis diagnosis);

/// What was answered says how well each direction is known, but not whether the motions agree.
Diagnosis diagnose_without_poses(const Answered& answered, const DiagnosisOptions& options);

/// Whether a stream is taken as its format says.
bool as_read(const Reading& reading);

}  // namespace egocal::detail
