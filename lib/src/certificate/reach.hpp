// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "certificate/double_proof.hpp"

// The distance within which any extrinsic that is at least as good lies: docs/method.md, "Reach".
namespace egocal::detail {

/// Rows P of linear forms of a competitor v'.
template <int N, std::size_t Rows>
using Forms = std::array<std::array<Extended, N>, Rows>;

/// The displacement p = q^-1 q' from the verified answer to a competitor: |rotation v'| is |p_v|, the sine of
/// half its angle, |translation v'| is |p_dv|, half its translation to first order.
template <int N>
struct Displacement;
template <>
struct Displacement<8> {
  Forms<8, 3> rotation, translation;
};
template <>
struct Displacement<4> {
  Forms<4, 1> rotation;
  Forms<4, 2> translation;
};

inline Displacement<8> displacement_from(const Column<8>& q) {
  // vector part of conj(x) y, row by row a linear form of y
  const auto rows = [](const Extended w, const Extended x, const Extended y, const Extended z) {
    return Forms<4, 3>{{{-x, w, z, -y}, {-y, -z, w, x}, {-z, y, -x, w}}};
  };
  const Forms<4, 3> r = rows(q[0], q[1], q[2], q[3]), d = rows(q[4], q[5], q[6], q[7]);
  Displacement<8> p;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      p.rotation[k][i] = r[k][i];
      p.rotation[k][i + 4] = 0;
      p.translation[k][i] = d[k][i];
      p.translation[k][i + 4] = r[k][i];
    }
  return p;
}

/// The displacement as forms of the planar variables q1, q4, q6, q7.
inline Displacement<4> displacement_from(const Column<4>& v) {
  const Extended c = v[0], s = v[1], x = v[2], y = v[3];
  return {{{{-s, c, 0, 0}}}, {{{-x, -y, c, s}, {-y, x, -s, c}}}};
}

struct Reach {
  double translation = std::numeric_limits<double>::infinity();  ///< [units of length]
  double rotation = std::numeric_limits<double>::infinity();     ///< [rad]
  /// The proof holds for competitors within this distance of the answer [units of length].
  double domain = std::numeric_limits<double>::infinity();
};

/// Parts of a guess that are tried. The guess itself is not less than the truth.
inline constexpr std::array<double, 3> parts_of_guess = {0.99, 0.5, 0.05};

/// A part of the guess that is proven: Z - c P'P >= 0, so J(q') - bound >= c |P v'|^2. Zero where none is.
/// The entries of the difference are rounded by less than 8 u sqrt(z_ii z_jj), u = epsilon / 2, which is at
/// most 8 N u of Z's diagonal.
template <int N, std::size_t Rows>
double proven_curvature(const ExtendedSquare<N>& Z, const Forms<N, Rows>& P, double guess) {
  if (!(guess > 0)) return 0;
  const Extended rounding = 4 * N * extended_epsilon();
  for (const double part : parts_of_guess) {
    const double c = part * guess;
    ExtendedSquare<N> M = Z;
    for (std::size_t i = 0; i < N; ++i) {
      M[i][i] -= rounding * Z[i][i];
      for (std::size_t j = 0; j <= i; ++j)
        for (const auto& row : P)
          M[i][j] -= c * row[static_cast<std::size_t>(reordered<N>(i))] *
                     row[static_cast<std::size_t>(reordered<N>(j))];
    }
    if (proven_semidefinite<N>(M)) return c;
  }
  return 0;
}

/// Tuning of proven_reach().
struct ReachOptions {
  /// Where D is singular up to rounding (rotations without noise), a reach is stated only if it holds for
  /// extrinsics within at least this distance of the answer [units of length: about the distance travelled
  /// per radian]. No sensor is mounted 10,000 times that far away. Motions that turn about all axes alike
  /// reach 2e7 (docs/method.md, "Singular D"). Study: tests/bench/certificate_study.cpp.
  double least_domain = 1e4;
};

/// Parts of the guesses that are proven, with a bound that is proven with this multiplier and lift. Zero
/// where none is; without a rotation none of the translation is looked for.
template <int N>
Curvatures proven_curvatures(const Square<N>& Q, const Column<N>& v, double bound, double orthogonal,
                             double lift, const Curvatures& guess) {
  const ExtendedSquare<N> Z = reordered_lagrangian<N>(Q, bound, orthogonal, lift);
  const Displacement<N> p = displacement_from(v);
  Curvatures c;
  c.rotation = proven_curvature<N>(Z, p.rotation, guess.rotation);
  if (c.rotation > 0) c.translation = proven_curvature<N>(Z, p.translation, guess.translation);
  return c;
}

/// The reach of competitors with a cost at most J. `bound` and the curvatures are proven, with this lift.
/// Where D is singular up to rounding the domain has to be at least options.least_domain.
template <int N>
Reach proven_reach(const Column<N>& v, double J, double bound, double lift, const Curvatures& proven,
                   const ReachOptions& options = {}) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double c_r = proven.rotation, c_t = proven.translation;
  Reach reach;
  if (!(c_r > 0) || !(c_t > 0)) return reach;

  // the rounding of P'P, of J and of the answer, which is a unit dual quaternion to epsilon only
  const double slack = 64 * static_cast<double>(extended_epsilon());
  const double d = v.template tail<N / 2>().norm();
  // c |P v'|^2 <= gap + lift |d'|^2 - lift |d|^2 <= gap + 2 lift |p_d|^2, with |d'| <= |d| + |p_d|
  const double gap = (J - bound) * (1 + 4 * epsilon) + 4 * epsilon * std::abs(J) + 2 * lift * d * d;
  double sine_squared = gap / c_r + slack;
  if (lift > 0) {
    reach.domain = std::sqrt(0.5 * c_r / lift);  // there 2 lift |p_d|^2 is a quarter of c_r
    sine_squared += 0.25;
    if (!(reach.domain >= options.least_domain)) return {};
  }
  if (!(sine_squared < 0.81)) return {};
  // |p_dv|^2 >= |p_d|^2 (1 - sine^2), |t| = 2 |p_d|
  const double denominator = c_t * (1 - sine_squared - 8 * slack) - 2 * lift;
  if (!(denominator > 0)) return {};
  const double p_d_squared = (gap + 32 * slack * c_t * d * d) / denominator;
  sine_squared = (gap + 2 * lift * p_d_squared) / c_r + slack;
  reach.rotation = 2 * std::asin(std::sqrt(sine_squared)) + 8 * epsilon;
  reach.translation = 2 * std::sqrt(p_d_squared) + 8 * epsilon * (1 + d);
  if (!(reach.translation <= reach.domain) || !std::isfinite(reach.rotation)) return {};
  return reach;
}

}  // namespace egocal::detail
