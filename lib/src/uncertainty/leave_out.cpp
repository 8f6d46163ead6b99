// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/uncertainty/leave_out.hpp"

#include <Eigen/Cholesky>
#include <limits>

#include "egocal/solvers/planar.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;

std::vector<Vector6d> leave_out_differences(const Problem& problem, const Matrix8d& Q_metres,
                                            const DualQuaternion& T_a_b) {
  std::vector<Vector6d> differences;
  const Statistics all = sum_blocks(problem.blocks);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const double length = detail::length_scale(Q_metres);
  const DualQuaternion q = detail::in_units_of(length, T_a_b);
  const Matrix86d T = detail::frame_a_basis(q);
  for (const Statistics& block : problem.blocks) {
    if (detail::takes_off(block)) continue;
    Statistics rest = all;
    rest.dual_rows -= block.dual_rows;
    rest.weight -= block.weight;
    const Matrix8d Q_rest = cost_matrix(rest, problem.balance);
    if (problem.mode == Mode::planar) {
      differences.push_back(
          detail::frame_a_difference(T_a_b, extrinsic_from_planar(solve_planar(Q_rest).q, G_a, G_b)));
      continue;
    }
    const Matrix8d Q_scaled = detail::in_units_of(length, Q_rest);
    const Matrix8d Z = lagrangian_matrix(Q_scaled, least_squares_multipliers(Q_scaled, q));
    const Matrix86d ZT = Z.lazyProduct(T);
    const Matrix6d H = T.transpose().lazyProduct(ZT);
    const Eigen::LDLT<Matrix6d> factor(H);
    Vector6d step = Vector6d::Constant(std::numeric_limits<double>::infinity());
    if (factor.info() == Eigen::Success && factor.isPositive()) {
      step = -factor.solve(ZT.transpose() * q.vec());
      step.head<3>() *= length;
    }
    differences.push_back(step);
  }
  return differences;
}

}  // namespace egocal
