// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "egocal/problem/cost.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// A sum of motions S as one Newton step from an extrinsic q needs it: 42 numbers, linear in S. Forms of
/// blocks are added and subtracted in place of the blocks, so omitting a block costs one small factorisation.
/// Not normalised by the weight, on which no Newton step depends.
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

/// Numbers of four problems side by side, as four are computed at the cost of one.
template <std::size_t n>
using Fours = std::array<std::array<double, 4>, n>;

/// The number of each row at place k.
inline Vector6d column(const Fours<6>& numbers, std::size_t k) {
  return {numbers[0][k], numbers[1][k], numbers[2][k], numbers[3][k], numbers[4][k], numbers[5][k]};
}

/// Forms of four blocks: the lower triangles of their curvatures, by columns.
struct FourForms {
  static constexpr std::size_t count = 4;  // numbers in 32 bytes, the width of AVX2
  Fours<21> curvature{};
  Fours<6> gradient{};

  void set(std::size_t k, const TangentForm& form);
  TangentForm form(std::size_t k) const;  ///< symmetric
};

/// The content of a TangentSpace as plain numbers: columns of 4 or of 6.
struct TangentNumbers {
  double rotation = 1, translation = 1;
  double upper[7][4], lower[7][4];      ///< [tangent, q], the dual rows counted in metres
  double norm[6][6], orthogonal[6][6];  ///< T'[I 0; 0 0]T and T'[0 I; I 0]T
  /// lambda' = (Sq)' times these; the lower half of Sq counted in metres
  double norm_of_real[4], norm_of_dual[4], orthogonal_of_real[4], orthogonal_of_dual[4];
};

/// Coordinates x in R^6 of the extrinsics around q: directions are the columns of `tangent`, tangent to the
/// constraints (17). Lengths of q and of the directions are counted in `length` [m].
class TangentSpace {
 public:
  TangentSpace(const DualQuaternion& q, double length, const Matrix86d& tangent, const Balance& balance);

  /// The form of the cost of these statistics. Its curvature is that of Z = S - lambda_1 [I 0; 0 0] +
  /// lambda_2 [0 I; I 0] at the least squares multipliers, which are linear in S as well.
  TangentForm form(const Statistics& statistics) const;
  /// Whether the first three directions do not rotate.
  bool starts_with_translations() const { return starts_with_translations_; }
  /// Forms of four statistics, up to rounding, at little more than the cost of one, in a space that starts
  /// with translations. in_pairs: as on processors without AVX2, with the same bits (for tests).
  FourForms forms(const std::array<const Statistics*, 4>& statistics, bool in_pairs = false) const;
  /// The Newton step to the minimum of the form, in the first `directions` coordinates; the others are zero.
  /// Infinite where the curvature is not positive definite.
  static Vector6d newton_step(const TangentForm& form, int directions = 6);
  /// Newton steps of the sum without each of four parts, in all six coordinates: the same bits as
  /// newton_step() of the differences, at little more than the cost of one.
  static Fours<6> newton_steps_without(const TangentForm& all, const FourForms& parts, bool in_pairs = false);

 private:
  Balance balance_;
  Eigen::Matrix<double, 4, 7> upper_, lower_;  ///< [tangent, q], the dual rows counted in metres
  bool starts_with_translations_;              ///< the first three directions do not rotate
  Eigen::Matrix<double, 6, 4> tangent_upper_, tangent_lower_;  ///< of the tangent alone, transposed
  Matrix6d norm_, orthogonal_;                                 ///< T'[I 0; 0 0]T and T'[0 I; I 0]T
  Eigen::Matrix<double, 8, 2> multipliers_;                    ///< lambda' = (Sq)' times this
  double length_;
  TangentNumbers numbers_;
};

/// The sums of the numbers of each of four symmetric matrices, column by column of the upper triangle, times
/// the columns of a TriangleProducts; zero where they are negative.
using TriangleProducts = Eigen::Matrix<double, 6, 21>;
Fours<6> sums_of_products(const FourForms& forms, const TriangleProducts& products, bool in_pairs = false);

/// L D L' of the leading n x n block in place (unit L below the diagonal, the inverse of D on it), from the
/// lower triangle. False where a pivot is not positive.
bool factorise(Matrix6d& A, int n = 6);
/// Solves with the factors of factorise(); entries from n on are left as they are.
void solve_factorised(const Matrix6d& factors, Vector6d& x, int n = 6);

}  // namespace egocal::detail
