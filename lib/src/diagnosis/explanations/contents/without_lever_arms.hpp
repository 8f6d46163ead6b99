// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether explanations fit better by what lever arms do not explain. Where both sensors turn about one point
// that is nothing: another lever arm then makes up for positions in other axes, and a shorter one turns less
// noise of the rotations into noise of the positions.
#pragma once

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

/// "Study" is tests/bench/mistake_study.cpp.
struct LeverArmOptions {
  /// Standard deviations, at least, of the signed-rank test of residuals without lever arms. This test asks
  /// less than the test of the whole residuals (DiagnosisOptions::sigmas), which has chosen the explanation
  /// already: a lever arm found from one stream alone is known less. With 3.5 two causes of the study's 132,
  /// both at 10 % noise, are not named.
  double sigmas = 3;
};

/// The same motions, with the squared residuals between the displacements of the stillest points of both
/// bodies, each found from its own stream alone. length: unit of the residuals, the same for explanations
/// that are compared [m].
Explained without_lever_arms(const Explained& explained, double length);

}  // namespace egocal::detail
