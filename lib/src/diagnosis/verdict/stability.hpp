// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/diagnosis/options.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::detail {

struct UnstableOptions {
  /// A direction is unstable where the spread below is this many times its standard deviation, and beyond the
  /// tolerance of an answer. By chance five parts show 2.7 times of it in one of a thousand (F distribution).
  /// Of 88 clean drives of two independent simulators five show more than 10 times, all of machines that
  /// hardly turn, one 7, and the others at most 2.4.
  double times = 10;
};

/// Standard deviation of each direction (x y z roll pitch yaw in sensor a's frame [m, rad]) from answers
/// without each fifth of the drive in turn. Long parts see what short blocks do not: errors that wander for
/// minutes, and an answer that hinges on one curve. Zero where there are too few blocks.
std::array<double, 6> spread_without_fifths(const Problem& problem, const DualQuaternion& T_a_b,
                                            const StabilityOptions& options = {});

}  // namespace egocal::detail
