// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "extended_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace egocal::bench {

namespace {

using Vector = std::array<Extended, 8>;

Extended absolute(Extended x) {
  return x < 0 ? -x : x;
}

Extended root(Extended x) {
  if (!(x > 0)) return 0;
  Extended y = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3; ++i) y = (y + x / y) / 2;  // Newton: doubles the digits
  return y;
}

Vector extended(const DualQuaternion& q) {
  Vector x;
  const Vector8d v = q.vec();
  for (std::size_t i = 0; i < 8; ++i) x[i] = v[static_cast<Eigen::Index>(i)];
  return x;
}

void project(Vector& x) {
  Extended rr = 0, rd = 0;
  for (std::size_t i = 0; i < 4; ++i) rr += x[i] * x[i];
  const Extended norm = root(rr);
  for (Extended& value : x) value /= norm;
  for (std::size_t i = 0; i < 4; ++i) rd += x[i] * x[i + 4];
  for (std::size_t i = 0; i < 4; ++i) x[i + 4] -= rd * x[i];
}

Vector times(const Matrix8d& Q, const Vector& x) {
  Vector y{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 8; ++j)
      y[i] += Extended(Q(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))) * x[j];
  return y;
}

Extended dot(const Vector& x, const Vector& y) {
  Extended sum = 0;
  for (std::size_t i = 0; i < 8; ++i) sum += x[i] * y[i];
  return sum;
}

struct Lambda {
  Extended norm, orthogonal;
};

/// Least squares of (28) for an x on the constraints: the columns (-r, 0) and (d, r) are orthogonal there.
Lambda multipliers(const Matrix8d& Q, const Vector& x) {
  const Vector g = times(Q, x);
  Extended norm = 0, product = 0, dd = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    norm += x[i] * g[i];
    product -= x[i + 4] * g[i] + x[i] * g[i + 4];
    dd += x[i + 4] * x[i + 4];
  }
  return {norm, product / (1 + dd)};
}

/// Gauss with complete pivoting. False where a pivot vanishes.
template <std::size_t N>
bool solve(std::array<std::array<Extended, N>, N> A, std::array<Extended, N> b, std::array<Extended, N>& x) {
  std::array<std::size_t, N> column;
  for (std::size_t i = 0; i < N; ++i) column[i] = i;
  Extended first = 0;
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t row = k, col = k;
    for (std::size_t i = k; i < N; ++i)
      for (std::size_t j = k; j < N; ++j)
        if (absolute(A[i][j]) > absolute(A[row][col])) {
          row = i;
          col = j;
        }
    if (k == 0) first = absolute(A[row][col]);
    if (!(absolute(A[row][col]) > Extended(1e-28) * first)) return false;
    std::swap(A[k], A[row]);
    std::swap(b[k], b[row]);
    for (std::size_t i = 0; i < N; ++i) std::swap(A[i][k], A[i][col]);
    std::swap(column[k], column[col]);
    for (std::size_t i = k + 1; i < N; ++i) {
      const Extended factor = A[i][k] / A[k][k];
      for (std::size_t j = k; j < N; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t j = k + 1; j < N; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  for (std::size_t k = 0; k < N; ++k) x[column[k]] = b[k];
  return true;
}

/// Q - lambda_1 [I 0; 0 0] + lambda_2 [0 I; I 0] of (21).
std::array<std::array<Extended, 8>, 8> lagrangian(const Matrix8d& Q, const Lambda& lambda) {
  std::array<std::array<Extended, 8>, 8> Z;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 8; ++j)
      Z[i][j] = Q(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  for (std::size_t i = 0; i < 4; ++i) {
    Z[i][i] -= lambda.norm;
    Z[i][i + 4] += lambda.orthogonal;
    Z[i + 4][i] += lambda.orthogonal;
  }
  return Z;
}

/// One Newton step on the KKT system of (18), bordered with both constraints' gradients. False where it is
/// singular.
bool newton(const Matrix8d& Q, Vector& x) {
  const auto Z = lagrangian(Q, multipliers(Q, x));
  std::array<std::array<Extended, 10>, 10> K{};
  std::array<Extended, 10> right{}, step{};
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      K[i][j] = Z[i][j];
      right[i] -= Z[i][j] * x[j];
    }
    K[i][8] = K[8][i] = i < 4 ? -x[i] : Extended(0);
    K[i][9] = K[9][i] = i < 4 ? x[i + 4] : x[i - 4];
  }
  if (!solve(K, right, step)) return false;
  for (std::size_t i = 0; i < 8; ++i) x[i] += step[i];
  project(x);
  return true;
}

/// Whether the matrix is positive semidefinite, by factorisation with diagonal pivoting; pivots below `floor`
/// of their own diagonal entry count as zero.
template <std::size_t N>
bool semidefinite(std::array<std::array<Extended, N>, N> M, Extended floor) {
  std::array<bool, N> done{};
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t pivot = N;
    for (std::size_t i = 0; i < N; ++i)
      if (!done[i] && (pivot == N || M[i][i] > M[pivot][pivot])) pivot = i;
    if (M[pivot][pivot] < -floor) return false;
    done[pivot] = true;
    if (!(M[pivot][pivot] > floor)) continue;
    for (std::size_t i = 0; i < N; ++i) {
      if (done[i]) continue;
      const Extended factor = M[i][pivot] / M[pivot][pivot];
      for (std::size_t j = 0; j < N; ++j)
        if (!done[j]) M[i][j] -= factor * M[pivot][j];
    }
  }
  return true;
}

DualQuaternion rounded(const Vector& x) {
  Vector8d v;
  for (std::size_t i = 0; i < 8; ++i) v[static_cast<Eigen::Index>(i)] = static_cast<double>(x[i]);
  return canonical_sign(normalized(DualQuaternion::from_vec(v)));
}

}  // namespace

Extended extended_cost(const Matrix8d& Q, const DualQuaternion& q) {
  Vector x = extended(q);
  project(x);
  return dot(x, times(Q, x));
}

Reference reference(const Matrix8d& Q, const std::vector<DualQuaternion>& starts) {
  Reference best;
  bool any = false;
  Vector best_x{};
  for (const DualQuaternion& start : starts) {
    Vector x = extended(start);
    project(x);
    Extended cost = dot(x, times(Q, x));
    Vector kept = x;
    for (int i = 0; i < 4 && newton(Q, x); ++i) {
      const Extended next = dot(x, times(Q, x));
      if (!(next <= cost)) break;
      cost = next;
      kept = x;
    }
    if (!any || cost < best.cost) {
      best.cost = cost;
      best_x = kept;
      any = true;
    }
  }
  best.q = rounded(best_x);
  Lambda lambda = multipliers(Q, best_x);
  const Extended trace = Q.trace();
  lambda.norm = best.cost - Extended(1e-22) * trace;
  best.proven = semidefinite(lagrangian(Q, lambda), Extended(1e-30) * trace);
  return best;
}

Reference planar_reference(const Matrix8d& Q) {
  // u'A u + 2 u'B v + v'D v with u = (q1, q4), v = (q6, q7); v = -inv(D) B' u
  const Extended d11 = Q(5, 5), d12 = Q(5, 6), d22 = Q(6, 6);
  const Extended determinant = d11 * d22 - d12 * d12;
  const Extended b[2][2] = {{Q(0, 5), Q(0, 6)}, {Q(3, 5), Q(3, 6)}};
  Extended w[2][2] = {};  // inv(D) B', one row for each u
  const bool turning = determinant > Extended(1e-28) * (d11 + d22) * (d11 + d22);
  for (int i = 0; i < 2 && turning; ++i) {
    w[i][0] = (d22 * b[i][0] - d12 * b[i][1]) / determinant;
    w[i][1] = (d11 * b[i][1] - d12 * b[i][0]) / determinant;
  }
  const Extended s11 = Extended(Q(0, 0)) - b[0][0] * w[0][0] - b[0][1] * w[0][1];
  const Extended s12 = Extended(Q(0, 3)) - b[0][0] * w[1][0] - b[0][1] * w[1][1];
  const Extended s22 = Extended(Q(3, 3)) - b[1][0] * w[1][0] - b[1][1] * w[1][1];
  const Extended half = (s11 - s22) / 2;
  const Extended radius = root(half * half + s12 * s12);
  Extended c = 1, s = 0;
  if (radius > 0) {
    c = half <= 0 ? radius - half : -s12;
    s = half <= 0 ? -s12 : radius + half;
    const Extended norm = root(c * c + s * s);
    c /= norm;
    s /= norm;
  }
  Reference best;
  best.cost = (s11 + s22) / 2 - radius;
  best.proven = turning;
  best.q = rounded({c, 0, 0, s, 0, -(c * w[0][0] + s * w[1][0]), -(c * w[0][1] + s * w[1][1]), 0});
  return best;
}

}  // namespace egocal::bench
