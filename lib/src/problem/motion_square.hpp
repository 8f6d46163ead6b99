// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "egocal/problem/cost.hpp"

namespace egocal::detail {

/// Unit quaternions a and b before their signs are made equal: the factor of each that makes its scalar >= 0.
inline double positive_sign(const DualQuaternion& motion) {
  return motion.real[0] < 0 ? -1 : 1;
}

/// E = R(q_b) - L(q_a) of (10) is s I + K with K = [0 -u'; u -[w]x] antisymmetric: scalars' difference,
/// vectors' difference and sum.
struct QuaternionDifference {
  double s, u[3], w[3];

  QuaternionDifference(const QuaternionVector& a, double sign_a, const QuaternionVector& b, double sign_b) {
    s = sign_b * b[0] - sign_a * a[0];
    for (int i = 0; i < 3; ++i) {
      u[i] = sign_b * b[i + 1] - sign_a * a[i + 1];
      w[i] = sign_b * b[i + 1] + sign_a * a[i + 1];
    }
  }

  /// Trace of E'E.
  double squared_size() const {
    const double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2], ww = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    return 4 * s * s + 2 * (uu + ww);
  }
  /// E x.
  QuaternionVector times(const QuaternionVector& x) const {
    return {s * x[0] - (u[0] * x[1] + u[1] * x[2] + u[2] * x[3]),
            s * x[1] + u[0] * x[0] - (w[1] * x[3] - w[2] * x[2]),
            s * x[2] + u[1] * x[0] - (w[2] * x[1] - w[0] * x[3]),
            s * x[3] + u[2] * x[0] - (w[0] * x[2] - w[1] * x[1])};
  }
};

/// Row and column in the 8 x 8 matrix of each number of a motion's square, in the order of
/// problem/square_numbers.hpp. The matrix is symmetric.
inline constexpr std::array<std::array<int, 2>, 36> square_places = {
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {2, 2}, {3, 3}, {1, 2}, {1, 3}, {2, 3}, {0, 4}, {0, 5},
     {0, 6}, {0, 7}, {1, 4}, {2, 4}, {3, 4}, {1, 5}, {2, 6}, {3, 7}, {2, 7}, {3, 6}, {3, 5}, {1, 7},
     {1, 6}, {2, 5}, {4, 4}, {4, 5}, {4, 6}, {4, 7}, {5, 5}, {6, 6}, {7, 7}, {5, 6}, {5, 7}, {6, 7}}};

/// What is added of a square: translation times it, and rotation times its lower right block (the rotation
/// part D) in the upper left one. rotation_only: the latter alone.
struct SquareWeights {
  double rotation = 0, translation = 0;
  bool rotation_only = false;
};

/// M_d'M_d over the dual rows M_d = [E_d E_r] of one motion pair (14), as a matrix: of its 64 entries only 36
/// differ, but whole columns are added faster than numbers with two places each. Computed once, added to
/// several sums.
class MotionSquare {
 public:
  MotionSquare() = default;  ///< unset
  /// The square for the signs of a and b that make their scalars >= 0.
  MotionSquare(const DualQuaternion& a, const DualQuaternion& b);

  /// Adds the square, multiplied by eta. in_pairs: as on processors without wide vectors, for tests.
  void add_to(Matrix8d& sum, double eta = 1, bool in_pairs = false) const;
  /// Adds the square, weighted, to each of the sums.
  void add_weighted_to(std::span<Matrix8d* const> sums, const SquareWeights& weights,
                       bool in_pairs = false) const;
  /// The 64 entries, column by column.
  double* entries() { return entries_.data(); }

 private:
  std::array<double, 64> entries_;
};

}  // namespace egocal::detail
