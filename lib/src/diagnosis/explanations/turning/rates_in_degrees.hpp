// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct RatesInDegreesOptions {
  /// One stream turns this many times as far as the other one, at least, before it is looked at: 57 times in
  /// truth, less where it turns by more than half a turn in a row.
  double least_ratio = 8;
  /// Mean log ratio of the squared residuals, at least: as that of rotation vectors of another length
  /// (TurningScaleOptions::gain_of_vectors).
  double gain = 2;
  int motions = 32;  ///< one after the other in the drive; motions as given say nothing of a length
};

/// Finding turning_scale_a or turning_scale_b: poses that were summed up from turning rates in degrees a
/// second taken as radians. Each row's step is the screw of a twist (io/twist_integrator.cpp), so the twist
/// follows from it where it turns by less than half a turn. In radians it must explain the drive.
std::optional<Finding> rates_in_degrees(const Evidence& evidence, const DiagnosisOptions& options,
                                        const RatesInDegreesOptions& rates = {});

}  // namespace egocal::detail
