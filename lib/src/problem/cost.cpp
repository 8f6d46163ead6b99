// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

#include "egocal/problem/problem.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w) {
  const Matrix8d M = right_matrix(canonical_sign(b)) - left_matrix(canonical_sign(a));
  return M.transpose() * w.asDiagonal() * M;
}

namespace {

using detail::QuaternionDifference;

/// Where entry (i, j) of a symmetric 8 x 8 matrix and its mirror image go.
struct Symmetric {
  double* values;

  void set(int i, int j, double value) const {
    values[8 * j + i] = value;
    values[8 * i + j] = value;
  }
};

/// E'E = s^2 I - K^2 as the symmetric block with its first entry at (corner, corner). Number by number, as
/// temporary matrices and loops over three axes cost more than the arithmetic.
void set_square(const Symmetric& to, int corner, const QuaternionDifference& e) {
  const double ss = e.s * e.s, u0 = e.u[0], u1 = e.u[1], u2 = e.u[2], w0 = e.w[0], w1 = e.w[1], w2 = e.w[2];
  const double sw = ss + (w0 * w0 + w1 * w1 + w2 * w2);
  to.set(corner, corner, ss + (u0 * u0 + u1 * u1 + u2 * u2));
  to.set(corner, corner + 1, w1 * u2 - w2 * u1);
  to.set(corner, corner + 2, w2 * u0 - w0 * u2);
  to.set(corner, corner + 3, w0 * u1 - w1 * u0);
  to.set(corner + 1, corner + 1, sw + u0 * u0 - w0 * w0);
  to.set(corner + 2, corner + 2, sw + u1 * u1 - w1 * w1);
  to.set(corner + 3, corner + 3, sw + u2 * u2 - w2 * w2);
  to.set(corner + 1, corner + 2, u0 * u1 - w0 * w1);
  to.set(corner + 1, corner + 3, u0 * u2 - w0 * w2);
  to.set(corner + 2, corner + 3, u1 * u2 - w1 * w2);
}

/// E_d' E_r = (s_d I - K_d)(s_r I + K_r) as the upper right block, its transpose as the lower left one.
void set_product(const Symmetric& to, const QuaternionDifference& d, const QuaternionDifference& r) {
  const double d0 = d.u[0], d1 = d.u[1], d2 = d.u[2], r0 = r.u[0], r1 = r.u[1], r2 = r.u[2];
  const double dw0 = d.w[0], dw1 = d.w[1], dw2 = d.w[2], rw0 = r.w[0], rw1 = r.w[1], rw2 = r.w[2];
  const double u0 = d.s * r0 - r.s * d0, u1 = d.s * r1 - r.s * d1, u2 = d.s * r2 - r.s * d2;
  const double w0 = d.s * rw0 - r.s * dw0, w1 = d.s * rw1 - r.s * dw1, w2 = d.s * rw2 - r.s * dw2;
  const double ss = d.s * r.s, sw = ss + (dw0 * rw0 + dw1 * rw1 + dw2 * rw2);
  to.set(0, 4, ss + (d0 * r0 + d1 * r1 + d2 * r2));
  to.set(0, 5, (rw1 * d2 - rw2 * d1) - u0);
  to.set(0, 6, (rw2 * d0 - rw0 * d2) - u1);
  to.set(0, 7, (rw0 * d1 - rw1 * d0) - u2);
  to.set(1, 4, u0 + (dw1 * r2 - dw2 * r1));
  to.set(2, 4, u1 + (dw2 * r0 - dw0 * r2));
  to.set(3, 4, u2 + (dw0 * r1 - dw1 * r0));
  to.set(1, 5, sw + d0 * r0 - rw0 * dw0);
  to.set(2, 6, sw + d1 * r1 - rw1 * dw1);
  to.set(3, 7, sw + d2 * r2 - rw2 * dw2);
  // -[w]x holds +w_i at (j, k) and -w_i at (k, j)
  to.set(2, 7, d1 * r2 - rw1 * dw2 + w0);
  to.set(3, 6, d2 * r1 - rw2 * dw1 - w0);
  to.set(3, 5, d2 * r0 - rw2 * dw0 + w1);
  to.set(1, 7, d0 * r2 - rw0 * dw2 - w1);
  to.set(1, 6, d0 * r1 - rw0 * dw1 + w2);
  to.set(2, 5, d1 * r0 - rw1 * dw0 - w2);
}

}  // namespace

detail::MotionSquare::MotionSquare(const DualQuaternion& a, const DualQuaternion& b) {
  // The dual rows of Q_b^r - Q_a^l are [E_d E_r] (10), for both signs scalar >= 0.
  const double sa = positive_sign(a), sb = positive_sign(b);
  const QuaternionDifference real(a.real, sa, b.real, sb), dual(a.dual, sa, b.dual, sb);
  const Symmetric values{values_.data()};
  set_square(values, 0, dual);
  set_product(values, dual, real);
  set_square(values, 4, real);
}

void Statistics::add(const DualQuaternion& a, const DualQuaternion& b, double eta) {
  detail::MotionSquare(a, b).add_to(dual_rows, eta);
  weight += eta;
  ++count;
}

Statistics& Statistics::operator+=(const Statistics& other) {
  dual_rows += other.dual_rows;
  weight += other.weight;
  count += other.count;
  return *this;
}

Matrix8d cost_matrix(const Statistics& statistics, const Balance& balance) {
  if (!(statistics.weight > 0)) return Matrix8d::Zero();
  Matrix8d Q = balance.translation / statistics.weight * statistics.dual_rows;
  Q.topLeftCorner<4, 4>() +=
      balance.rotation / statistics.weight * statistics.dual_rows.bottomRightCorner<4, 4>();
  return Q;
}

Statistics sum_blocks(const std::vector<Statistics>& blocks) {
  Statistics sum;
  for (const Statistics& block : blocks) sum += block;
  return sum;
}

double cost(const Matrix8d& Q, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  return v.dot(Q.lazyProduct(v));
}

Matrix8d cost_matrix(const Problem& problem) {
  return cost_matrix(sum_blocks(problem.blocks), problem.balance);
}

}  // namespace egocal
