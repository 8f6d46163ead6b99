// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions of which one stream is changed by a few numbers: what a mistake in it adds to each translation.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"

namespace egocal::detail {

/// The instant at which each of the motions begins that motions_of() has made of them, by their times.
std::vector<std::size_t> begins_of(const Instants& instants, const Motions& motions);

/// Sets the motion of one stream, in the frame of its begin [m].
void set_motion(Motion& motion, Side side, const Rotation& rotation, const Eigen::Vector3d& translation);

/// The motions where this is added to the translations of one stream, in the frame of each begin [m]. Their
/// typical sizes stay those of the motions as given.
Motions with_added(Motions motions, const std::vector<Eigen::Vector3d>& added, Side side);

/// Sets the motion of one stream where it also turns by another angle.
void set_turned_motion(Motion& motion, Side side, const Rotation& rotation,
                       const Eigen::Vector3d& translation);

/// The n numbers that suit the translations best, beside a change of the extrinsic: linear least squares.
/// added: per motion, what each number adds to the translation of the stream, in the frame of its begin.
template <int n>
Eigen::Matrix<double, n, 1> best_numbers(const Explained& given,
                                         const std::vector<Eigen::Matrix<double, 3, n>>& added, Side side) {
  const Pose T = to_pose(given.fit.T);
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6 + n, 6 + n> sum = Eigen::Matrix<double, 6 + n, 6 + n>::Zero();
  Eigen::Matrix<double, 6 + n, 1> right = Eigen::Matrix<double, 6 + n, 1>::Zero();
  for (std::size_t i = 0; i < given.motions.all.size(); ++i) {
    const Motion& motion = given.motions.all[i];
    const double weight = given.fit.weights[i];
    const Eigen::Vector3d there = R * motion.t_b;
    const Eigen::Vector3d residual = motion.R_a * T.translation + motion.t_a - there - T.translation;
    Eigen::Matrix<double, 3, 6 + n> rows;
    rows.template leftCols<3>() = motion.R_a - Eigen::Matrix3d::Identity();
    rows.template middleCols<3>(3) = cross_matrix(there);
    if (side == Side::a)
      rows.template rightCols<n>() = added[i];
    else
      rows.template rightCols<n>() = -(R * added[i]);
    add_square(sum, weight, rows);
    add_product(right, -weight, rows, residual);
  }
  sum.diagonal().array() += 1e-9 * sum.trace() / (6 + n) + 1e-300;  // what is not shown stays as it is
  return solve_symmetric(sum, right).template bottomRows<n>();
}

}  // namespace egocal::detail
