// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "egocal/uncertainty/observability.hpp"
#include "samples/sample_fit.hpp"

namespace egocal::detail {

/// Standard deviations of X in sensor a's frame (x y z roll pitch yaw, [m, rad]) from the answers without
/// each sample in turn; samples of one unit (shared_poses.hpp) go together. With Student's factor: 1.96 of
/// them cover 95 %. Infinite where there are fewer than 4 units. Up to most_solved units each answer is
/// solved for, beyond it is one Newton step. Where a direction is hidden (hidden_directions() at fit.X), the
/// answers without each of most_solved groups of units are solved for instead, and what the answer may be off
/// along it counts in the directions that it leans into.
std::array<double, 6> spread_without_each(const SampleSet& set, const std::vector<std::size_t>& chosen,
                                          const SampleFit& fit, const DirectionBasis& hidden,
                                          std::size_t most_solved);

}  // namespace egocal::detail
