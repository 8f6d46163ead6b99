// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a fit needs of its samples, as sums: whatever the origin, in constant time.
#pragma once

#include <Eigen/Core>
#include <array>

#include "egocal/problem/problem.hpp"
#include "samples/seen_target.hpp"

namespace egocal::detail {

/// Sums over samples of the target that each of them sees, y = a X c with c = b^-1. They hold the cost at
/// every origin of the positions. Squares are sums of large numbers whose differences count: good to 1e-15 of
/// the squared positions and no further, so the last round of a fit goes through the samples themselves.
struct SampleSums {
  double count = 0;
  Eigen::Matrix4d real = Eigen::Matrix4d::Zero(), dual = Eigen::Matrix4d::Zero();  ///< with their signs
  Eigen::Matrix4d dual_dual = Eigen::Matrix4d::Zero(), dual_real = Eigen::Matrix4d::Zero();
  /// 2 X.real' moment[k] X.real is twice the position along axis k except for the part of X.dual.
  std::array<Eigen::Matrix4d, 3> moment{Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Zero(),
                                        Eigen::Matrix4d::Zero()};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();  ///< of a

  void add(const SampleSums& one, double sign);

  /// Statistics of all motions between two samples, divided by the number of samples; positions are from
  /// `origin` [m], where twice the length of a dual part is the distance.
  Statistics centred(const Eigen::Vector3d& origin) const;
  /// The mean of the targets that are seen with this X.
  DualQuaternion mean_target(const DualQuaternion& X) const;
};

/// The numbers of one sample; a.real: its rotation.
SampleSums sums_of(const SeenTarget& seen, const QuaternionVector& a_real);

}  // namespace egocal::detail
