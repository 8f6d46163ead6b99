// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Scale and extrinsic together, near their common minimum: derivatives, and the jack-knife by one Newton
// step.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "egocal/problem/problem.hpp"
#include "egocal/scale/scale_statistics.hpp"

namespace egocal::detail {

/// Where the derivatives are taken: J = (weighted sum over the statistics) / weight at the scale e^u and the
/// extrinsic q (planar mode: T_p).
struct ScalePoint {
  double scale = 1;
  DualQuaternion q;
  Balance balance;          ///< in force at this scale
  double weight_slope = 0;  ///< d log(translation weight) / d u
  double weight = 1;        ///< of all statistics
  Mode mode = Mode::spatial;
};

/// Half of the gradient and of the second derivatives over x y z roll pitch yaw in the frame of q (planar
/// mode: x y yaw), and then u.
struct ScaleDerivatives {
  using Gradient = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1>;
  using Hessian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 7, 7>;
  Gradient gradient;
  Hessian hessian;

  /// Derivatives over u, with the best extrinsic at each scale.
  struct OverScale {
    double curvature = 0;  ///< second derivative of J over u; 0 where the extrinsic is at no minimum
    std::array<double, 6> sensitivity{};  ///< change of the extrinsic per change of u
  };
  OverScale over_scale() const;
};

/// Derivatives of the part of J that these statistics are; with those of all of them they add up.
class JointForm {
 public:
  JointForm(const ScaleStatistics& all, const ScalePoint& point);
  ScaleDerivatives of(const ScaleStatistics& part) const;

 private:
  ScalePoint point_;
  Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 6> tangents_;
  double norm_ = 0, orthogonal_ = 0;  ///< the constraints' multipliers, for each unit of weight
};

/// Standard deviation of u by the jack-knife over blocks of unequal length (delete-m_j, Busing et al. 1999),
/// each dropped by one Newton step over scale and extrinsic together, with Student's factor as for the
/// extrinsic. Infinite where it is unknown: also with fewer than least_blocks. all: of(sum of the blocks).
double spread_of_scale(std::span<const ScaleStatistics> blocks, const JointForm& form,
                       const ScaleDerivatives& all, std::size_t least_blocks);

}  // namespace egocal::detail
