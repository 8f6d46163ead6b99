// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "egocal/layout.hpp"

namespace egocal::detail {

template <int N>
using Square = Eigen::Matrix<double, N, N, Eigen::DontAlign>;
template <int N>
using Column = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;

using Extended = long double;  ///< 64 bits of mantissa where the machine has them; never less than double
template <std::size_t N>
using ExtendedSquare = std::array<std::array<Extended, N>, N>;

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53);
static_assert(std::numeric_limits<Extended>::digits == 53 || std::numeric_limits<Extended>::digits == 64 ||
                  std::numeric_limits<Extended>::digits == 113,
              "the margins of the proofs hold for IEEE double, x87 and binary128, not for pairs of doubles");

/// The precision that Extended really has: an x87 set to 53 bits, or an emulator, may compute with that of
/// double.
inline Extended extended_epsilon() {
  constexpr Extended claimed = std::numeric_limits<Extended>::epsilon();
  volatile Extended one = 1;
  const volatile Extended next = one + claimed;
  return next - one == claimed ? claimed : Extended(std::numeric_limits<double>::epsilon());
}

/// Roots of the traces of A and D, the sizes of the numbers that were summed up to Q = [A B; B' D]. The
/// entries of Q do not show them: they may cancel.
struct Sizes {
  double A = 0, D = 0;
};
template <int N>
Sizes sizes_of(const Square<N>& Q) {
  const auto root = [](double trace) { return trace > 0 ? std::sqrt(trace) : 0; };
  return {root(Q.diagonal().template head<N / 2>().sum()), root(Q.diagonal().template tail<N / 2>().sum())};
}

/// Units in the last place to which the sums in Q are known (docs/method.md, "Rounding").
inline constexpr double known_to = 16 * std::numeric_limits<double>::epsilon();

/// Costs of v = (r, d) that differ by less cannot be distinguished.
template <int N>
double rounding_of(const Sizes& sizes, const Column<N>& v) {
  const double size = sizes.A * v.template head<N / 2>().norm() + sizes.D * v.template tail<N / 2>().norm();
  return known_to * size * size;
}

template <int N>
double extended_cost(const Square<N>& Q, const Column<N>& v) {
  Extended sum = 0;
  for (int i = 0; i < N; ++i) {
    Extended row = 0;
    for (int j = 0; j < N; ++j) row += static_cast<Extended>(Q(i, j)) * v[j];
    sum += row * v[i];
  }
  return static_cast<double>(sum);
}

/// Proves that a symmetric matrix is positive semidefinite; false proves nothing. A factorisation L D L' that
/// runs to its end in floating point factors a matrix whose entries differ from the given ones by at most
/// (n + 2) u sqrt(m_ii m_jj), u = epsilon / 2 (Higham, theorems 10.5 and 10.7, and the reciprocal), so
/// n (n + 2) u of the diagonal would be enough to be given away. Twice n (n + 1) epsilon is, which covers the
/// rounding of the given entries as well.
template <std::size_t N>
bool proven_semidefinite(ExtendedSquare<N> M) {
  const Extended margin = static_cast<Extended>(2 * N * (N + 1)) * extended_epsilon();
  std::array<bool, N> empty{};  // a variable that the form does not contain
  for (std::size_t i = 0; i < N; ++i) {
    empty[i] = true;
    for (std::size_t j = 0; j < N; ++j) empty[i] = empty[i] && M[i][j] == 0;
    M[i][i] -= margin * std::abs(M[i][i]);
  }
  for (std::size_t j = 0; j < N; ++j) {
    if (empty[j]) continue;
    if (!(M[j][j] > 0)) return false;
    const Extended inverse = 1 / M[j][j];
    for (std::size_t i = j + 1; i < N; ++i) {
      const Extended factor = M[i][j] * inverse;
      for (std::size_t k = j + 1; k <= i; ++k) M[i][k] -= factor * M[k][j];
    }
  }
  return true;
}

/// The place of a variable in the matrices to be proven: the second half first, where elimination is best
/// conditioned.
template <int N>
constexpr int reordered(std::size_t i) {
  return (static_cast<int>(i) + N / 2) % N;
}

/// Z of a quadratic problem with |u| = 1, u the first half of the variables, as both modes have it, plus
/// `lift` on the diagonal of the second half.
template <int N>
ExtendedSquare<N> reordered_lagrangian(const Square<N>& Q, Extended bound, Extended orthogonal,
                                       Extended lift) {
  constexpr std::size_t half = N / 2;  // real and dual part
  ExtendedSquare<N> Z;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j) Z[i][j] = Q(reordered<N>(i), reordered<N>(j));
  for (std::size_t i = 0; i < half; ++i) {
    Z[i][i] += lift;
    Z[i + half][i + half] -= bound;
    Z[i][i + half] += orthogonal;
    Z[i + half][i] += orthogonal;
  }
  return Z;
}

/// Whether this is proven: J(q') + lift |d'|^2 >= bound for every q' with |r'| = 1 and r'd' = 0.
template <int N>
bool proven_bound(const Square<N>& Q, double bound, double orthogonal, double lift) {
  return proven_semidefinite<N>(reordered_lagrangian<N>(Q, bound, orthogonal, lift));
}

/// Whether this is proven: no cost is negative by more than its rounding. Q is a sum of squares, as far as it
/// is known.
template <int N>
bool proven_sum_of_squares(const Square<N>& Q, const Sizes& sizes) {
  ExtendedSquare<N> M = reordered_lagrangian<N>(Q, 0, 0, 0);
  for (std::size_t i = 0; i < N; ++i) {
    const double size = i < N / 2 ? sizes.D : sizes.A;
    M[i][i] += static_cast<Extended>(known_to) * size * size;
  }
  return proven_semidefinite<N>(M);
}

}  // namespace egocal::detail
