// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Hand-eye methods that OpenCV offers, on all motions between two samples.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::testing {

struct PoseMotion {
  Pose a, b;
};

inline std::vector<PoseMotion> all_motions(const std::vector<PoseSample>& samples) {
  std::vector<PoseMotion> motions;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j)
      motions.push_back(
          {to_pose(conjugate(samples[i].a) * samples[j].a), to_pose(conjugate(samples[i].b) * samples[j].b)});
  return motions;
}

/// Translation by least squares at a rotation.
inline Pose with_translation(const std::vector<PoseMotion>& motions, const Eigen::Matrix3d& R) {
  const auto n = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd C(3 * n, 3);
  Eigen::VectorXd d(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PoseMotion& motion = motions[static_cast<std::size_t>(k)];
    C.block<3, 3>(3 * k, 0) = Eigen::Matrix3d::Identity() - motion.a.rotation.toRotationMatrix();
    d.segment<3>(3 * k) = motion.a.translation - R * motion.b.translation;
  }
  return {Rotation(R), C.colPivHouseholderQr().solve(d)};
}

inline Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

/// Park and Martin 1994.
inline Pose park(const std::vector<PoseMotion>& motions) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (const PoseMotion& motion : motions)
    M += rotation_log(motion.a.rotation) * rotation_log(motion.b.rotation).transpose();
  return with_translation(motions, nearest_rotation(M));
}

/// Andreff, Horaud and Espiau 1999.
inline Pose andreff(const std::vector<PoseMotion>& motions) {
  const auto n = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(12 * n, 12);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(12 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PoseMotion& motion = motions[static_cast<std::size_t>(k)];
    const Eigen::Matrix3d R_a = motion.a.rotation.toRotationMatrix(),
                          R_b = motion.b.rotation.toRotationMatrix();
    // row-major vec(X): vec(R_a X R_b') = (R_a kron R_b) vec(X)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        A.block<3, 3>(12 * k + 3 * i, 3 * j) = -R_a(i, j) * R_b;
        if (i == j) A.block<3, 3>(12 * k + 3 * i, 3 * j) += Eigen::Matrix3d::Identity();
      }
    for (int i = 0; i < 3; ++i) A.block<1, 3>(12 * k + 9 + i, 3 * i) = motion.b.translation.transpose();
    A.block<3, 3>(12 * k + 9, 9) = Eigen::Matrix3d::Identity() - R_a;
    b.segment<3>(12 * k + 9) = motion.a.translation;
  }
  const Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = x[3 * i + j];
  return {Rotation(nearest_rotation(R)), x.tail<3>()};
}

}  // namespace egocal::testing
