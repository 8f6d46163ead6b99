// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/stillest_point.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace egocal::detail {

Eigen::Matrix3d rotation_of(const DualQuaternion& motion) {
  return Eigen::Quaterniond(motion.real[0], motion.real[1], motion.real[2], motion.real[3])
      .toRotationMatrix();
}

/// The sum of lengths is least by reweighted least squares, each motion by the inverse of its length: a jump
/// hardly changes it.
std::vector<Eigen::Vector3d> at_stillest_point(const std::vector<BodyMotion>& motions) {
  constexpr int rounds = 8;  // limit on time
  std::vector<Eigen::Vector3d> displacements;
  double way = 0;
  displacements.reserve(motions.size());
  for (const BodyMotion& motion : motions) {
    displacements.push_back(motion.t);
    way += motion.t.norm();
  }
  if (!(way > 0)) return displacements;
  // rounding: six digits of a usual motion
  const double least = 1e-6 * way / static_cast<double>(motions.size());
  const auto turn_of = [](const BodyMotion& motion) -> Eigen::Matrix3d {
    return motion.R - Eigen::Matrix3d::Identity();
  };
  for (int round = 0; round < rounds; ++round) {
    Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Eigen::Matrix3d turn = turn_of(motions[i]);
      const double weight = 1 / (displacements[i].norm() + least);
      curvature += weight * turn.transpose() * turn;
      gradient -= weight * turn.transpose() * motions[i].t;
    }
    // a direction of the point that no motion shows stays zero
    curvature.diagonal().array() += 1e-12 * curvature.trace() + 1e-300;
    const Eigen::Vector3d point = curvature.ldlt().solve(gradient);
    for (std::size_t i = 0; i < motions.size(); ++i)
      displacements[i] = motions[i].t + turn_of(motions[i]) * point;
  }
  return displacements;
}

}  // namespace egocal::detail
