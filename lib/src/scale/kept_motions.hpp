// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/scale/solve_scale.hpp"

namespace egocal::detail {

/// The pairs whose ratio of lengths is within a factor of two of the median ratio. Lever arms change it by
/// less while the vehicle drives on; a jump of one stream changes it by more.
std::vector<MotionPair> of_plausible_length(std::span<const MotionPair> pairs);

/// |a q - q b|^2, weighted as in the solution, with the scale on its side.
double scale_residual(const MotionPair& pair, const ScaleSolution& solution, Side side);

/// Rotations and translations weigh alike where nothing is known of their noise.
Balance even_balance(std::span<const ScaleStatistics> blocks, Side side);

/// Weights by the inverse variances of both residuals at the solution, from their medians. Empty where there
/// is no noise to compare.
std::optional<Balance> noise_balance(std::span<const MotionPair> pairs, const ScaleSolution& solution,
                                     Side side);

}  // namespace egocal::detail
