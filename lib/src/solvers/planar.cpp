// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/global.hpp"

#include <cmath>
#include <limits>

#include "egocal/problem/cost.hpp"

namespace egocal {

Solution solve_planar(const Matrix8d& Q) {
  Solution solution;
  if (!Q.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return solution;
  }
  // J = u'A u + 2 u'B v + v'D v with u = (q1, q4), |u| = 1, and v = (q6, q7) free: g2 holds by itself
  const double d11 = Q(5, 5), d12 = Q(5, 6), d22 = Q(6, 6);
  const double determinant = d11 * d22 - d12 * d12;
  const double d_trace = d11 + d22;
  // D is s I up to noise (the sine of the rotation); where nothing turns, v does not matter and stays zero
  const bool turning = determinant > 16 * std::numeric_limits<double>::epsilon() * d_trace * d_trace &&
                       d_trace > 1e-28 * (Q(0, 0) + Q(3, 3));
  const auto inverse_times = [&](double x, double y, double& vx, double& vy) {
    vx = turning ? (d22 * x - d12 * y) / determinant : 0;
    vy = turning ? (d11 * y - d12 * x) / determinant : 0;
  };
  const double b11 = Q(0, 5), b12 = Q(0, 6), b21 = Q(3, 5), b22 = Q(3, 6);
  double x1, y1, x2, y2;  // inv(D) B'
  inverse_times(b11, b12, x1, y1);
  inverse_times(b21, b22, x2, y2);
  const double s11 = Q(0, 0) - (b11 * x1 + b12 * y1);
  const double s12 = Q(0, 3) - (b11 * x2 + b12 * y2);
  const double s22 = Q(3, 3) - (b21 * x2 + b22 * y2);

  // smaller eigenvector of the 2 x 2 Schur complement
  const double half_difference = 0.5 * (s11 - s22);
  const double radius = std::hypot(half_difference, s12);
  double c = 1, s = 0;
  if (radius > 0) {
    // of (a - l, b), (b, d - l) take the longer row: no cancellation
    if (half_difference <= 0) {
      c = radius - half_difference;
      s = -s12;
    } else {
      c = -s12;
      s = radius + half_difference;
    }
    const double norm = std::hypot(c, s);
    c /= norm;
    s /= norm;
  } else if (!(s11 > 0)) {
    solution.status = SolverStatus::degenerate;
  }
  solution.q.real = {c, 0, 0, s};
  solution.q.dual = {0, -(x1 * c + x2 * s), -(y1 * c + y2 * s), 0};
  solution.q = canonical_sign(solution.q);
  solution.cost = cost(Q, solution.q);
  solution.lambda = {solution.cost, 0};
  solution.iterations = 1;
  return solution;
}

}  // namespace egocal
