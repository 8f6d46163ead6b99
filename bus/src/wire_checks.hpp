// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Checks that several messages need before their numbers are used.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::bus {

/// Largest entry of statistics: products of two such entries stay far from overflow.
inline constexpr double largest_entry = 1e30;

/// Whether no value is negative or NaN. Infinity may be meant: unknown.
bool not_negative(std::initializer_list<double> values);

/// Whether no value is negative, and all are finite.
bool finite_not_negative(std::initializer_list<double> values);

/// Whether a direction that is not observable has a finite standard deviation. The other way round may be
/// meant: too few motions say how well a direction is known.
bool directions_contradict(const std::int8_t (&observable)[6], const double (&stddev)[6]);

/// Whether the diagonal bounds the other entries, as in a sum of M'M (Cauchy-Schwarz), up to `slack` [unit of
/// the matrix].
bool bounded_by_diagonal(const Matrix8d& matrix, double slack);

}  // namespace egocal::bus
