// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/list_axes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "egocal/geometry/pose.hpp"
#include "samples/rotations_alone.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;

/// The signed permutation that is nearest to a matrix.
Matrix3d nearest_columns(const Matrix3d& W) {
  std::array<int, 3> order{0, 1, 2}, best = order;
  double largest = -1;
  do {
    double sum = 0;
    for (int row = 0; row < 3; ++row) sum += std::abs(W(row, order[static_cast<std::size_t>(row)]));
    if (sum > largest) {
      largest = sum;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  Matrix3d columns = Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    const int column = best[static_cast<std::size_t>(row)];
    columns(row, column) = W(row, column) < 0 ? -1 : 1;
  }
  return columns;
}

/// What the positions of the wrong list must be multiplied by, by least squares.
Matrix3d best_matrix(std::span<const PoseSample> samples, Side wrong, const Rotation& R_Y) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * n, 15);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PoseSample& sample = samples[static_cast<std::size_t>(k)];
    const Pose a = to_pose(sample.a), b = to_pose(sample.b);
    const Eigen::Vector3d here = a.translation, there = R_Y * b.translation;
    const Eigen::Vector3d& multiplied = wrong == Side::a ? a.translation : b.translation;
    // of b: V t_b + t_Y - R_a t_X = t_a with V = R_Y W; of a: V t_a - t_Y + R_a t_X = R_Y t_b with V = W
    for (int row = 0; row < 3; ++row) J.block<1, 3>(3 * k + row, 3 * row) = multiplied.transpose();
    const double sign = wrong == Side::a ? -1 : 1;
    J.block<3, 3>(3 * k, 9) = sign * Matrix3d::Identity();
    J.block<3, 3>(3 * k, 12) = -sign * a.rotation.toRotationMatrix();
    right.segment<3>(3 * k) = wrong == Side::a ? there : here;
  }
  const Eigen::VectorXd x = J.colPivHouseholderQr().solve(right);
  Matrix3d V;
  for (int row = 0; row < 3; ++row) V.row(row) = x.segment<3>(3 * row).transpose();
  return wrong == Side::a ? V : Matrix3d(R_Y.conjugate().toRotationMatrix() * V);
}

}  // namespace

std::vector<PoseReading> list_axes_readings(std::span<const PoseSample> samples, Side wrong,
                                            int rounds_of_signs, const ListAxesOptions& options) {
  std::vector<PoseReading> readings;
  for (const bool conjugate : {false, true}) {
    PoseReading mirrored;
    mirrored.conjugate = conjugate;
    mirrored.axes = -Matrix3d::Identity();
    readings.push_back(mirrored);
    if (samples.size() < options.least_for_columns) continue;
    std::vector<PoseSample> read(samples.begin(), samples.end());
    if (conjugate)
      for (PoseSample& sample : read) {
        DualQuaternion& pose = wrong == Side::a ? sample.a : sample.b;
        PoseReading inverse_rotation;
        inverse_rotation.conjugate = true;
        pose = reread(pose, inverse_rotation);
      }
    const QuaternionVector Y = rotations_alone(read, rounds_of_signs).Y;
    PoseReading other = mirrored;
    other.axes = nearest_columns(best_matrix(read, wrong, Rotation(Y[0], Y[1], Y[2], Y[3])));
    if (!as_given(other) && other.axes != mirrored.axes) readings.push_back(other);
  }
  return readings;
}

}  // namespace egocal::detail
