// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "uncertainty/surroundings.hpp"

namespace egocal::detail {

/// In the plane; the hidden directions come first, seen in sensor a's frame. pairs: in all blocks.
Surroundings look_around_in_plane(const Problem& problem, const Matrix8d& Q_metres,
                                  const DualQuaternion& T_a_b, std::uint64_t pairs,
                                  const ObservabilityOptions& options);

/// A coordinate of sensor a's frame must also be one of the plane: x and y lie in it, yaw turns about its
/// normal.
std::array<bool, 6> observable_in_plane(const Problem& problem, const Surroundings& around,
                                        ErrorCorrelation errors, const ObservabilityOptions& options);

/// assess_observability() of a planar problem that shows anything.
Observability planar_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options);

}  // namespace egocal::detail
