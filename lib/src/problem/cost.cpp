// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "egocal/problem/problem.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w) {
  const Matrix8d M = right_matrix(canonical_sign(b)) - left_matrix(canonical_sign(a));
  return M.transpose() * w.asDiagonal() * M;
}

namespace {

using detail::QuaternionDifference;

/// Row and column of the upper triangle's entries of E'E in a 4 x 4 block, in the order of set_square().
constexpr std::array<std::array<int, 2>, 10> square_entries = {
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {2, 2}, {3, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// The same of E_d'E_r in the upper right block, in the order of set_product().
constexpr std::array<std::array<int, 2>, 16> product_entries = {{{0, 4},
                                                                 {0, 5},
                                                                 {0, 6},
                                                                 {0, 7},
                                                                 {1, 4},
                                                                 {2, 4},
                                                                 {3, 4},
                                                                 {1, 5},
                                                                 {2, 6},
                                                                 {3, 7},
                                                                 {2, 7},
                                                                 {3, 6},
                                                                 {3, 5},
                                                                 {1, 7},
                                                                 {1, 6},
                                                                 {2, 5}}};

/// E'E = s^2 I - K^2. Number by number, as temporary matrices and loops over three axes cost more than the
/// arithmetic.
void set_square(const QuaternionDifference& e, double* to) {
  const double ss = e.s * e.s, u0 = e.u[0], u1 = e.u[1], u2 = e.u[2], w0 = e.w[0], w1 = e.w[1], w2 = e.w[2];
  const double sw = ss + (w0 * w0 + w1 * w1 + w2 * w2);
  to[0] = ss + (u0 * u0 + u1 * u1 + u2 * u2);
  to[1] = w1 * u2 - w2 * u1;
  to[2] = w2 * u0 - w0 * u2;
  to[3] = w0 * u1 - w1 * u0;
  to[4] = sw + u0 * u0 - w0 * w0;
  to[5] = sw + u1 * u1 - w1 * w1;
  to[6] = sw + u2 * u2 - w2 * w2;
  to[7] = u0 * u1 - w0 * w1;
  to[8] = u0 * u2 - w0 * w2;
  to[9] = u1 * u2 - w1 * w2;
}

/// E_d' E_r = (s_d I - K_d)(s_r I + K_r).
void set_product(const QuaternionDifference& d, const QuaternionDifference& r, double* to) {
  const double d0 = d.u[0], d1 = d.u[1], d2 = d.u[2], r0 = r.u[0], r1 = r.u[1], r2 = r.u[2];
  const double dw0 = d.w[0], dw1 = d.w[1], dw2 = d.w[2], rw0 = r.w[0], rw1 = r.w[1], rw2 = r.w[2];
  const double u0 = d.s * r0 - r.s * d0, u1 = d.s * r1 - r.s * d1, u2 = d.s * r2 - r.s * d2;
  const double w0 = d.s * rw0 - r.s * dw0, w1 = d.s * rw1 - r.s * dw1, w2 = d.s * rw2 - r.s * dw2;
  const double ss = d.s * r.s, sw = ss + (dw0 * rw0 + dw1 * rw1 + dw2 * rw2);
  to[0] = ss + (d0 * r0 + d1 * r1 + d2 * r2);
  to[1] = (rw1 * d2 - rw2 * d1) - u0;
  to[2] = (rw2 * d0 - rw0 * d2) - u1;
  to[3] = (rw0 * d1 - rw1 * d0) - u2;
  to[4] = u0 + (dw1 * r2 - dw2 * r1);
  to[5] = u1 + (dw2 * r0 - dw0 * r2);
  to[6] = u2 + (dw0 * r1 - dw1 * r0);
  to[7] = sw + d0 * r0 - rw0 * dw0;
  to[8] = sw + d1 * r1 - rw1 * dw1;
  to[9] = sw + d2 * r2 - rw2 * dw2;
  // -[w]x holds +w_i at (j, k) and -w_i at (k, j)
  to[10] = d1 * r2 - rw1 * dw2 + w0;
  to[11] = d2 * r1 - rw2 * dw1 - w0;
  to[12] = d2 * r0 - rw2 * dw0 + w1;
  to[13] = d0 * r2 - rw0 * dw2 - w1;
  to[14] = d0 * r1 - rw0 * dw1 + w2;
  to[15] = d1 * r0 - rw1 * dw0 - w2;
}

/// Adds eta times entry k to its place (shifted by `corner`) and to the mirrored one.
template <const auto& entries, int corner, std::size_t... k>
[[gnu::always_inline]] inline void add_entries(double* sum, const double* values, double eta,
                                               std::index_sequence<k...>) {
  const auto add = [sum](int i, int j, double value) {
    const double total = sum[8 * j + i] + value;
    sum[8 * j + i] = total;
    sum[8 * i + j] = total;
  };
  (add(entries[k][0] + corner, entries[k][1] + corner, eta * values[k]), ...);
}

}  // namespace

detail::MotionSquare::MotionSquare(const DualQuaternion& a, const DualQuaternion& b) {
  // The dual rows of Q_b^r - Q_a^l are [E_d E_r] (10), for both signs scalar >= 0.
  const double sa = positive_sign(a), sb = positive_sign(b);
  const QuaternionDifference real(a.real, sa, b.real, sb), dual(a.dual, sa, b.dual, sb);
  set_square(dual, dual_);
  set_product(dual, real, product_);
  set_square(real, real_);
}

void detail::MotionSquare::add_to(Matrix8d& sum, double eta) const {
  double* const to = sum.data();
  add_entries<square_entries, 0>(to, dual_, eta, std::make_index_sequence<10>());
  add_entries<product_entries, 0>(to, product_, eta, std::make_index_sequence<16>());
  add_entries<square_entries, 4>(to, real_, eta, std::make_index_sequence<10>());
}

detail::MotionSquare detail::MotionSquare::weighted(double rotation, double translation,
                                                    bool rotation_only) const {
  const double all = rotation_only ? 0.0 : translation;
  MotionSquare result;
  for (int k = 0; k < 10; ++k) result.dual_[k] = all * dual_[k] + rotation * real_[k];
  for (int k = 0; k < 16; ++k) result.product_[k] = all * product_[k];
  for (int k = 0; k < 10; ++k) result.real_[k] = all * real_[k];
  return result;
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
