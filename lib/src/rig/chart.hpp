// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "rig/pair_form.hpp"

namespace egocal::detail::joint {

/// Coordinates y of one pose, p = p0 + eps e + C y, in which the pair with sensor 0 costs at least |y|^2 more
/// than its bound.
struct Chart {
  std::array<Vector8, 6> C;  ///< columns, imaginary dual quaternions
  double u = 0, v = 0;       ///< |real part of C y| <= u |y|, |dual part| <= v |y|
};

/// The chart of a pose from its pair with sensor 0, its inequality proven; empty where it cannot be.
std::optional<Chart> chart_of(const Form& form);

using Matrix6 = std::array<std::array<double, 6>, 6>;

}  // namespace egocal::detail::joint
