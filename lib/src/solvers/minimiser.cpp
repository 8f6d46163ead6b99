// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solvers/minimiser.hpp"

#include "egocal/solvers/global.hpp"

namespace egocal::detail {

DualQuaternion minimiser(const Matrix8d& Q, Mode mode) {
  return mode == Mode::planar ? solve_planar(Q).q : solve_dual(Q).q;
}

DualQuaternion extrinsic_of(const Problem& problem, const DualQuaternion& q) {
  if (problem.mode == Mode::spatial) return q;
  return extrinsic_from_planar(q, plane_frame(problem.plane_a), plane_frame(problem.plane_b));
}

DualQuaternion extrinsic_of(const Problem& problem, const Statistics& statistics) {
  return extrinsic_of(problem, minimiser(cost_matrix(statistics, problem.balance), problem.mode));
}

}  // namespace egocal::detail
