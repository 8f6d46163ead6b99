// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/sample_sums.hpp"

#include <cmath>

namespace egocal::detail {

namespace {

/// Multiplication from the left by the imaginary unit of each axis exchanges rows; and by a vector.
std::array<Eigen::Matrix4d, 3> times_units(const Eigen::Matrix4d& m) {
  std::array<Eigen::Matrix4d, 3> turned;
  turned[0] << -m.row(1), m.row(0), -m.row(3), m.row(2);
  turned[1] << -m.row(2), m.row(3), m.row(0), -m.row(1);
  turned[2] << -m.row(3), -m.row(2), m.row(1), m.row(0);
  return turned;
}
Eigen::Matrix4d left_of(const Eigen::Vector3d& v) {
  QuaternionVector q;
  q << 0, v;
  return left_matrix(q);
}

Eigen::Matrix3d rotation_matrix(const QuaternionVector& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

}  // namespace

SampleSums sums_of(const SeenTarget& seen, const QuaternionVector& a_real) {
  SampleSums sums;
  sums.count = 1;
  sums.real = seen.real;
  sums.dual = seen.dual;
  sums.dual_dual.noalias() = seen.dual.transpose() * seen.dual;
  sums.dual_real.noalias() = seen.dual.transpose() * seen.real;
  const std::array<Eigen::Matrix4d, 3> turned = times_units(seen.real);
  for (std::size_t k = 0; k < 3; ++k) sums.moment[k].noalias() = seen.dual.transpose() * turned[k];
  sums.rotation = rotation_matrix(a_real);
  return sums;
}

void SampleSums::add(const SampleSums& one, double sign) {
  count += one.count;
  real += sign * one.real;
  dual += sign * one.dual;
  dual_dual += one.dual_dual;
  dual_real += one.dual_real;
  for (std::size_t k = 0; k < 3; ++k) moment[k] += one.moment[k];
  rotation += one.rotation;
}

Statistics SampleSums::centred(const Eigen::Vector3d& origin) const {
  // The dual part from the origin is dual - 1/2 t real, and real is orthogonal, so real' t real is the
  // product by the vector turned into the frame of a.
  const Eigen::Matrix4d half = 0.5 * left_of(origin), mean_dual = dual - half * real;
  Eigen::Matrix4d shift = Eigen::Matrix4d::Zero();
  for (std::size_t k = 0; k < 3; ++k) shift += 0.5 * origin[static_cast<int>(k)] * moment[k];
  Eigen::Matrix4d dd = dual_dual - shift - shift.transpose() - mean_dual.transpose() * mean_dual / count;
  dd.diagonal().array() += 0.25 * origin.squaredNorm() * count;
  const Eigen::Matrix4d dr =
      dual_real + 0.5 * left_of(rotation.transpose() * origin) - mean_dual.transpose() * real / count;
  Eigen::Matrix4d rr = -real.transpose() * real / count;
  rr.diagonal().array() += count;
  Statistics statistics;
  statistics.dual_rows.topLeftCorner<4, 4>() = 0.5 * (dd + dd.transpose());
  statistics.dual_rows.topRightCorner<4, 4>() = dr;
  statistics.dual_rows.bottomLeftCorner<4, 4>() = dr.transpose();
  statistics.dual_rows.bottomRightCorner<4, 4>() = 0.5 * (rr + rr.transpose());
  statistics.weight = count;
  const auto samples = static_cast<std::uint64_t>(count);
  statistics.count = samples * (samples - 1) / 2;
  return statistics;
}

DualQuaternion SampleSums::mean_target(const DualQuaternion& X) const {
  QuaternionVector mean = real * X.real;
  if (!(mean.norm() > 0)) mean = QuaternionVector::UnitX();
  mean.normalize();
  Eigen::Vector3d where;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d turned = rotation.transpose() * Eigen::Vector3d::Unit(k);
    where[k] =
        2 *
        (X.real.dot(moment[static_cast<std::size_t>(k)] * X.real) + X.dual.dot(left_of(turned) * X.real)) /
        count;
  }
  return shifted({mean, QuaternionVector::Zero()}, where);
}

}  // namespace egocal::detail
