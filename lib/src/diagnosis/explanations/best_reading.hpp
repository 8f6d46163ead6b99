// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the two files are best read: inverted, in another order, in other axes.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct BestReading {
  Explanation best;
  std::optional<Explanation> twin{};  ///< fits as well
  /// Rotations of both files are those of the inverse poses: set if the motions show it but do not prove it
  /// (CommonAxesOptions), whatever the best reading is.
  std::optional<Explanation> inverse_rotations{};
  /// Axes of one file are turned by a few degrees, likewise (TurnedAxesOptions).
  std::optional<Explanation> turned_axes{};
};

/// The reading as given, unless another one is clearly better; with a scale of b if the motions show one.
BestReading best_reading(const Evidence& evidence, const DiagnosisOptions& options);

}  // namespace egocal::detail
