// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "egocal/arithmetic.hpp"

namespace egocal::detail {

using Extended = long double;  ///< 64 bits of mantissa where the machine has them; never less than double
static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53);
static_assert(std::numeric_limits<Extended>::digits == 53 || std::numeric_limits<Extended>::digits == 64 ||
                  std::numeric_limits<Extended>::digits == 113,
              "the margins of the proofs hold for IEEE double, x87 and binary128, not for pairs of doubles");

template <int N>
using Square = Eigen::Matrix<double, N, N, Eigen::DontAlign>;
template <int N>
using Column = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;

/// Costs that differ by less cannot be told apart: the entries of Q are known to a few units in the last
/// place.
template <int N>
double rounding_of(const Square<N>& Q, const Column<N>& v) {
  return 16 * std::numeric_limits<double>::epsilon() * v.cwiseAbs().dot(Q.cwiseAbs() * v.cwiseAbs());
}

/// Proves that a symmetric matrix is positive semidefinite. A Cholesky factorisation that runs to its end in
/// floating point factors a matrix whose entries differ from the given ones by at most (n + 1) u sqrt(m_ii
/// m_jj) (Demmel, Higham theorem 10.5), so it is enough that it does so after the diagonal has been reduced
/// by n (n + 1) u of itself.
template <int N>
bool proven_semidefinite(std::array<std::array<Extended, N>, N> M) {
  constexpr Extended margin = 2 * N * (N + 1) * std::numeric_limits<Extended>::epsilon();
  for (int i = 0; i < N; ++i) M[i][i] -= margin * std::abs(M[i][i]);
  for (int j = 0; j < N; ++j) {
    if (!(M[j][j] > 0)) return false;
    const Extended inverse = 1 / M[j][j];
    for (int i = j + 1; i < N; ++i) {
      const Extended factor = M[i][j] * inverse;
      for (int k = j + 1; k <= i; ++k) M[i][k] -= factor * M[k][j];
    }
  }
  return true;
}

/// A quadratic problem |u| = 1, u the first half of the variables, as both modes have it: how to build the
/// Lagrangian matrix for a proposed bound, with the second half first, where elimination is best conditioned.
template <int N>
std::array<std::array<Extended, N>, N> reordered_lagrangian(const Square<N>& Q, Extended bound,
                                                            Extended orthogonal, Extended lift) {
  constexpr int half = N / 2;
  std::array<std::array<Extended, N>, N> Z;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) Z[i][j] = Q((i + half) % N, (j + half) % N);
  for (int i = 0; i < half; ++i) {
    Z[i][i] += lift;
    Z[i + half][i + half] -= bound;
    Z[i][i + half] += orthogonal;
    Z[i + half][i] += orthogonal;
  }
  return Z;
}

template <int N>
bool proven_bound(const Square<N>& Q, double bound, double orthogonal, double lift) {
  return proven_semidefinite<N>(reordered_lagrangian<N>(Q, bound, orthogonal, lift));
}

}  // namespace egocal::detail
