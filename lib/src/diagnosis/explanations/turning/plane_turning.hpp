// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the turns of a vehicle say of the normals of its ground planes: a vehicle turns about the normal of
// the ground it stands on, and both sensors turn alike.
#pragma once

#include <Eigen/Core>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

/// Axis that one sensor turns about, in its own frame.
struct AxisBesideNormal {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of length 1, on the side of the plane's normal
  double off = 0;                                  ///< from the normal [rad], at most a right angle
  double stddev = 0;                               ///< of `off` [rad], by leaving out parts of the drive
  /// Ratio of the mean squares of the turns about this axis and the next one: 1 where there is no axis.
  double ratio = 1;
};

/// Angle between the normal of a and that of b turned into the frame of a as the turns of both say [rad].
struct NormalsApart {
  double angle = 0, stddev = 0;
  /// Correlation of the turns of both sensors: 1 without noise, near 0 where they turn by noise alone. There
  /// the angle is of chance, and its standard deviation too small.
  double alike = 0;
};

struct PlaneTurning {
  AxisBesideNormal a, b;
  NormalsApart apart;
};

/// given: the motions with the extrinsic that suits them best, in all six directions; at least two motions.
/// blocks: number of parts of the drive for the jack-knife, which omits one at a time. More than there are
/// motions count as that many.
PlaneTurning plane_turning(const Explained& given, const Eigen::Vector3d& normal_a,
                           const Eigen::Vector3d& normal_b, std::size_t blocks);

}  // namespace egocal::detail
