// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/rotations_alone.hpp"

#include <vector>

#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

RotationsAlone rotations_alone(std::span<const PoseSample> samples, int rounds_of_signs) {
  std::vector<Eigen::Matrix4d> seen;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const PoseSample& sample : samples) {
    Eigen::Matrix4d one = left_matrix(sample.a.real) * right_matrix(quaternion_conjugate(sample.b.real));
    const PoseSample& first = samples.front();
    if ((first.a.real.dot(sample.a.real) < 0) != (first.b.real.dot(sample.b.real) < 0)) one = -one;
    sum += one;
    seen.push_back(one);
  }
  const auto n = static_cast<double>(samples.size());
  RotationsAlone result;
  double largest = 0;
  for (int round = 0; round < rounds_of_signs; ++round) {
    const SymmetricEigen<4> eigen = symmetric_eigen<4>(sum.transpose() * sum / n);
    largest = eigen.values[3];
    result.X = eigen.vectors.col(3);
    result.Y = sum * result.X;
    sum.setZero();
    for (Eigen::Matrix4d& one : seen) {
      if (result.Y.dot(one * result.X) < 0) one = -one;
      sum += one;
    }
  }
  result.Y.normalize();
  result.variance = 4 * (n - largest) / (3 * (n - 1));
  return result;
}

}  // namespace egocal::detail
