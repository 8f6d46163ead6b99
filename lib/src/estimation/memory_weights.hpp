// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Weights of strides by how long the noise is remembered: a motion of s steps
// counts by lambda^s, where lambda = exp(-1 / memory).
#pragma once

#include <optional>

#include "estimation/stride_ladder.hpp"

namespace egocal::detail {

/// lambda of rotation and of translation as the residuals suggest; both are
/// found together with the minimiser, in turn. Empty where no motion turns or
/// moves.
std::optional<WeightChoice> weights_by_residuals(const StrideLadder& ladder, Mode mode);

/// The weights of this memory [steps]. q: a minimiser to start from.
WeightChoice weights_by_memory(const StrideLadder& ladder, Mode mode, double memory, DualQuaternion q);

}  // namespace egocal::detail
