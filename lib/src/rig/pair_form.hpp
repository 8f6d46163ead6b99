// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The cost of one pair around the joint minimum, in the notation of docs/rigs.md. Plain loops: the compiler
// unrolls Eigen's products of this size for minutes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "certificate/proof.hpp"
#include "rig/joint.hpp"

namespace egocal::detail::joint {

/// A form x'Zx or a product of displacements in double precision is off by less than this part of the sum of
/// the absolute values of its terms: fewer than 64 roundings lie between the poses and any such number.
inline constexpr double form_error = 256 * std::numeric_limits<double>::epsilon();
/// Upper bounds that are made of positive terms alone are raised by this part.
inline constexpr double upwards = 1 + 1e-9;

/// p' of a dual quaternion in the order w x y z of real, then of dual.
using Vector8 = std::array<double, 8>;

inline double length(const Vector8& v, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += v[i] * v[i];
  return std::sqrt(sum);
}

/// x y of dual quaternions.
inline Vector8 product(const Vector8& x, const Vector8& y) {
  const auto add = [](const double* p, const double* q, double* r) {
    r[0] += p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
    r[1] += p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
    r[2] += p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
    r[3] += p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
  };
  Vector8 result{};
  add(x.data(), y.data(), result.data());
  add(x.data(), y.data() + 4, result.data() + 4);
  add(x.data() + 4, y.data(), result.data() + 4);
  return result;
}

/// Z(lambda) of one pair (21) at the joint minimum's m = q_a^-1 q_b: J(q') - bound = q''Z q' for unit q'.
class Form {
 public:
  Form(const JointPair& pair, const std::vector<DualQuaternion>& poses);

  double bound() const { return lambda_.norm; }
  double multiplier() const { return lambda_.orthogonal; }
  const Vector8& m() const { return m_; }

  /// (m x)'Z (m y).
  double at(const Vector8& x, const Vector8& y) const {
    const Vector8 mx = product(m_, x), my = product(m_, y);
    double sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      double row = 0;
      for (std::size_t k = 0; k < 8; ++k) row += Z_[i][k] * my[k];
      sum += mx[i] * row;
    }
    return sum;
  }
  /// Bounds the error of at(), from the lengths of the real and dual parts of x and y.
  double error_of(double xr, double xd, double yr, double yd) const {
    const double x = xd + lever_ * xr, y = yd + lever_ * yr;
    return form_error * (size_rr_ * xr * yr + size_rd_ * (xr * y + x * yr) + size_dd_ * x * y);
  }
  double error_of(const Vector8& x, const Vector8& y) const {
    return error_of(length(x, 0, 4), length(x, 4, 8), length(y, 0, 4), length(y, 4, 8));
  }
  /// An upper bound of (m x)'Z (m x).
  double at_most(const Vector8& x) const { return std::max(0.0, at(x, x)) + error_of(x, x); }
  /// An upper bound of the same for every x = (0, v), |v| = 1.
  double dual_at_most() const { return size_dd_ * upwards; }

 private:
  void set(const Matrix8d& Q, double bound);

  Vector8 m_;
  double lever_ = 0;  ///< m is a product of poses: the rounding of its dual part is that of theirs
  Multipliers lambda_;
  double minimum_ = 0;
  std::array<std::array<double, 8>, 8> Z_{};
  double size_rr_ = 0, size_rd_ = 0, size_dd_ = 0;  ///< Frobenius norms of Z's blocks
};

inline constexpr Vector8 real_one = {1, 0, 0, 0, 0, 0, 0, 0}, dual_one = {0, 0, 0, 0, 1, 0, 0, 0};

}  // namespace egocal::detail::joint
