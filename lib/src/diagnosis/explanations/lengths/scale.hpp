// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

struct ScaledFit {
  double scale = 1;  ///< the lengths of b times this are metres of a
  Explained explained;
};

enum class Effort { look, full };

/// The scale of b and the extrinsic that fit best, both sensors' translations weighing alike.
ScaledFit fit_with_scale(const Motions& motions, const DiagnosisOptions& options,
                         Effort effort = Effort::full);

/// Standard deviation of the logarithm of a scale that was fitted to these motions, of which `independent` do
/// not overlap; empty where they do not show it. A jack-knife over parts of the drive and the noise of the
/// motions against what they show of the scale, added: where one part of the drive holds nearly all that is
/// known of the scale, the jack-knife is too small by chance.
std::optional<double> stddev_of_log_scale(const Motions& motions, const ScaledFit& fit,
                                          std::size_t independent, const ScaleCheckOptions& options);

}  // namespace egocal::detail
