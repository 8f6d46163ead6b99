// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

#include "egocal/problem/problem.hpp"

namespace egocal {

Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w) {
  const Matrix8d M = right_matrix(canonical_sign(b)) - left_matrix(canonical_sign(a));
  return M.transpose() * w.asDiagonal() * M;
}

namespace {

/// E = R(q_b) - L(q_a) of (10) is s I + K with K = [0 -u'; u -[w]x] antisymmetric: scalars' difference,
/// vectors' difference and sum.
struct Difference {
  double s, u[3], w[3];

  Difference(const QuaternionVector& a, double sign_a, const QuaternionVector& b, double sign_b) {
    s = sign_b * b[0] - sign_a * a[0];
    for (int i = 0; i < 3; ++i) {
      u[i] = sign_b * b[i + 1] - sign_a * a[i + 1];
      w[i] = sign_b * b[i + 1] + sign_a * a[i + 1];
    }
  }
};

double dot(const double (&x)[3], const double (&y)[3]) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
/// Entry i of x cross y.
double cross(const double (&x)[3], const double (&y)[3], int i) {
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  return x[j] * y[k] - x[k] * y[j];
}

/// Adds eta E'E = eta (s^2 I - K^2), number by number: a temporary matrix costs more than the arithmetic.
void add_square(Matrix8d& sum, int corner, const Difference& e, double eta) {
  const auto add = [&](int i, int j, double value) { sum(corner + i, corner + j) += eta * value; };
  const double ss = e.s * e.s, ww = dot(e.w, e.w);
  add(0, 0, ss + dot(e.u, e.u));
  for (int i = 0; i < 3; ++i) {
    const double mixed = cross(e.w, e.u, i);
    add(0, i + 1, mixed);
    add(i + 1, 0, mixed);
    add(i + 1, i + 1, ss + ww + e.u[i] * e.u[i] - e.w[i] * e.w[i]);
    for (int j = i + 1; j < 3; ++j) {
      const double value = e.u[i] * e.u[j] - e.w[i] * e.w[j];
      add(i + 1, j + 1, value);
      add(j + 1, i + 1, value);
    }
  }
}

/// Adds eta E_d' E_r = eta (s_d I - K_d)(s_r I + K_r) to the upper right block, and its transpose to the
/// lower left.
void add_product(Matrix8d& sum, const Difference& d, const Difference& r, double eta) {
  const auto add = [&](int i, int j, double value) {
    sum(i, j + 4) += eta * value;
    sum(j + 4, i) += eta * value;
  };
  double u[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = d.s * r.u[i] - r.s * d.u[i];
    w[i] = d.s * r.w[i] - r.s * d.w[i];
  }
  const double ss = d.s * r.s, ww = dot(d.w, r.w);
  add(0, 0, ss + dot(d.u, r.u));
  for (int i = 0; i < 3; ++i) {
    add(0, i + 1, cross(r.w, d.u, i) - u[i]);
    add(i + 1, 0, u[i] + cross(d.w, r.u, i));
    add(i + 1, i + 1, ss + ww + d.u[i] * r.u[i] - r.w[i] * d.w[i]);
    const int j = (i + 1) % 3, k = (i + 2) % 3;  // -[w]x holds +w_i at (j, k) and -w_i at (k, j)
    add(j + 1, k + 1, d.u[j] * r.u[k] - r.w[j] * d.w[k] + w[i]);
    add(k + 1, j + 1, d.u[k] * r.u[j] - r.w[k] * d.w[j] - w[i]);
  }
}

}  // namespace

void Statistics::add(const DualQuaternion& a, const DualQuaternion& b, double eta) {
  // The dual rows of Q_b^r - Q_a^l are [E_d E_r] (10), for both signs scalar >= 0.
  const double sa = a.real[0] < 0 ? -1 : 1;
  const double sb = b.real[0] < 0 ? -1 : 1;
  const Difference real(a.real, sa, b.real, sb), dual(a.dual, sa, b.dual, sb);
  add_square(dual_rows, 0, dual, eta);
  add_product(dual_rows, dual, real, eta);
  add_square(dual_rows, 4, real, eta);
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
  return v.dot(Q * v);
}

Matrix8d cost_matrix(const Problem& problem) {
  return cost_matrix(sum_blocks(problem.blocks), problem.balance);
}

}  // namespace egocal
