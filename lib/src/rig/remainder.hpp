// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rig/chart.hpp"

namespace egocal::detail::joint {

/// |R| of one pair, what is left of its cost behind the second order, is at most product |y_a| |y_b| +
/// square_a |y_a|^2 + square_b |y_b|^2.
struct Remainder {
  double product = 0, square_a = 0, square_b = 0;
};

/// The remainder for two poses whose coordinates are at most `radius` long.
Remainder remainder_of(const Form& form, const Chart& a, const Chart& b, double radius);

/// The part that the scalars p0 - 1 and e of one pose add to the remainder.
double scalar_part(const Form& form, const Chart& chart, double c);

/// Least |p0| of a pose whose coordinates are at most `radius` long; 0 where it may vanish.
double least_scalar(const Chart& chart, double radius);

}  // namespace egocal::detail::joint
