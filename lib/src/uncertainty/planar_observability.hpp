// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "uncertainty/surroundings.hpp"

namespace egocal::detail {

/// The surroundings in the plane. The hidden directions come first, in the frame of sensor a. pairs: in all
/// blocks.
Surroundings look_around_in_plane(const Problem& problem, const Matrix8d& Q_metres,
                                  const DualQuaternion& T_a_b, std::uint64_t pairs,
                                  const ObservabilityOptions& options);

/// Which coordinates of the frame of sensor a are observable: they must also be coordinates of the plane. x
/// and y lie in it, yaw turns about its normal.
std::array<bool, 6> observable_in_plane(const Problem& problem, const Surroundings& around,
                                        ErrorCorrelation errors, const ObservabilityOptions& options);

/// assess_observability() of a planar problem in which something is seen.
Observability planar_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options);

}  // namespace egocal::detail
