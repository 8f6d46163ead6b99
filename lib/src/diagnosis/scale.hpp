// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/robust_fit.hpp"

namespace egocal::detail {

struct ScaledFit {
  double scale = 1;  ///< the lengths of b times this are metres of a
  Explained explained;
};

enum class Effort { look, full };

/// The scale of b and the extrinsic that fit best, both sensors' translations weighing alike.
ScaledFit fit_with_scale(const Motions& motions, const DiagnosisOptions& options,
                         Effort effort = Effort::full);

}  // namespace egocal::detail
