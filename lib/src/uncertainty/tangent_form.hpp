// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "egocal/problem/cost.hpp"
#include "solvers/tangent.hpp"

namespace egocal::detail {

/// What one Newton step from an extrinsic q needs of a sum of motions S: 42 numbers, linear in S. Forms of
/// blocks are added and subtracted instead of the blocks, so omitting a block costs one small
/// factorisation. Not normalised by the weight, which no Newton step depends on.
struct TangentForm {
  Matrix6d curvature = Matrix6d::Zero();  ///< T'ZT, see TangentSpace
  Vector6d gradient = Vector6d::Zero();   ///< T'Sq

  TangentForm& operator+=(const TangentForm& other) {
    curvature += other.curvature;
    gradient += other.gradient;
    return *this;
  }
  TangentForm& operator-=(const TangentForm& other) {
    curvature -= other.curvature;
    gradient -= other.gradient;
    return *this;
  }
  friend TangentForm operator-(TangentForm x, const TangentForm& y) { return x -= y; }
};

/// Coordinates x in R^6 of the extrinsics around q: directions are the columns of `tangent`, tangent to the
/// constraints (17). Lengths of q and of the directions are counted in `length` [m].
class TangentSpace {
 public:
  TangentSpace(const DualQuaternion& q, double length, const Matrix86d& tangent, const Balance& balance);

  /// Its curvature is that of Z = S - lambda_1 [I 0; 0 0] + lambda_2 [0 I; I 0] at the least squares
  /// multipliers, which are linear in S as well.
  TangentForm form(const Statistics& statistics) const;
  /// Of two, up to rounding, at little more than the cost of one.
  std::array<TangentForm, 2> forms(const Statistics& first, const Statistics& second) const;
  /// The Newton step to the minimum of the form, in the first `directions` coordinates; the others are zero.
  /// Infinite where the curvature is not positive definite.
  static Vector6d newton_step(const TangentForm& form, int directions = 6);
  /// Without one of two parts of a sum, in all six coordinates: the same bits as newton_step() of the
  /// differences, at little more than the cost of one.
  static std::array<Vector6d, 2> newton_steps_without(const TangentForm& all, const TangentForm& first,
                                                      const TangentForm& second);

 private:
  Balance balance_;
  Eigen::Matrix<double, 4, 7> upper_, lower_;  ///< [tangent, q], the dual rows counted in metres
  bool starts_with_translations_;              ///< the first three directions do not rotate
  Eigen::Matrix<double, 6, 4> tangent_upper_, tangent_lower_;  ///< of the tangent alone, transposed
  Matrix6d norm_, orthogonal_;                                 ///< T'[I 0; 0 0]T and T'[0 I; I 0]T
  Eigen::Matrix<double, 8, 2> multipliers_;                    ///< lambda' = (Sq)' times this
  double length_;
};

/// L D L' of the leading n x n block in place (unit L below the diagonal, the inverse of D on it), from the
/// lower triangle. False where a pivot is not positive.
bool factorise(Matrix6d& A, int n = 6);
/// Solves with the factors of factorise(); entries from n on are left as they are.
void solve_factorised(const Matrix6d& factors, Vector6d& x, int n = 6);

}  // namespace egocal::detail
