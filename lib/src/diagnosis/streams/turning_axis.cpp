// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/turning_axis.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/stillest_point.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

TurningAxis turning_axis(const Motions& motions, Side side) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Motion& motion : motions.all) {
    const Eigen::Matrix3d moved =
        rotation_of(side == Side::a ? motion.a : motion.b) - Eigen::Matrix3d::Identity();
    squares += moved.transpose() * moved;
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  return {eigen.vectors.col(0),
          std::sqrt(std::max(0.0, eigen.values[0]) / static_cast<double>(motions.all.size()))};
}

double turning_difference(const Motions& motions, const Eigen::Vector3d& axis_a,
                          const Eigen::Vector3d& axis_b) {
  const auto about = [](const Eigen::Vector3d& axis, const QuaternionVector& q) {
    return 2 * std::atan2(axis.dot(q.tail<3>()), q[0]);
  };
  double same = 0, opposite = 0;  // either end of an axis may be up
  for (const Motion& motion : motions.all) {
    const double of_a = about(axis_a, motion.a.real), of_b = about(axis_b, motion.b.real);
    same += std::pow(of_a - of_b, 2);
    opposite += std::pow(of_a + of_b, 2);
  }
  return std::sqrt(std::min(same, opposite) / static_cast<double>(motions.all.size()));
}

}  // namespace egocal::detail
