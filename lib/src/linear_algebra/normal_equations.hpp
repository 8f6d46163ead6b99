// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Weighted least squares. The sums are loops, and the solver is compiled once: as products and factors of
// fixed size, which Eigen unrolls, they took 25 s of a compiler in one file.
#pragma once

#include <Eigen/Core>

namespace egocal::detail {

/// sum += weight rows' rows, both triangles.
template <int m, int n>
void add_square(Eigen::Matrix<double, n, n>& sum, double weight, const Eigen::Matrix<double, m, n>& rows) {
  for (int column = 0; column < n; ++column) {
    for (int row = 0; row < column; ++row) {
      const double value = weight * rows.col(row).dot(rows.col(column));
      sum(row, column) += value;
      sum(column, row) += value;
    }
    sum(column, column) += weight * rows.col(column).squaredNorm();
  }
}

/// sum += weight rows' residual.
template <int m, int n>
void add_product(Eigen::Matrix<double, n, 1>& sum, double weight, const Eigen::Matrix<double, m, n>& rows,
                 const Eigen::Matrix<double, m, 1>& residual) {
  for (int row = 0; row < n; ++row) sum[row] += weight * rows.col(row).dot(residual);
}

/// Solution of A X = B for a symmetric, positive semidefinite A, by its LDL' factors with pivots.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The same for normal equations in numbers of unlike units: each is scaled to a unit of its own, and what
/// the equations do not show stays zero.
Eigen::VectorXd solve_in_units(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace egocal::detail
