// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "linear_algebra/cross_matrix.hpp"

namespace egocal::detail {

/// What multiplies the way [m] of a constant twist to give the translation of its screw. turn: the rotation
/// vector [rad]. No difference of nearly equal numbers is divided by a power of a small angle.
inline Eigen::Matrix3d screw_matrix(const Eigen::Vector3d& turn) {
  constexpr double small = 1e-2;  // [rad]: below, the terms that the series leaves out are under rounding
  const double angle = turn.norm(), square = angle * angle;
  const double sine = std::sin(0.5 * angle);
  // (1 - cos x) / x^2 and (x - sin x) / x^3
  const double first = angle < small ? 0.5 - square / 24 * (1 - square / 30) : 2 * sine * sine / square;
  const double second = angle < small ? 1.0 / 6 - square / 120 * (1 - square / 42)
                                      : (angle - std::sin(angle)) / (square * angle);
  const Eigen::Matrix3d cross = cross_matrix(turn);
  return Eigen::Matrix3d::Identity() + first * cross + second * cross * cross;
}

}  // namespace egocal::detail
