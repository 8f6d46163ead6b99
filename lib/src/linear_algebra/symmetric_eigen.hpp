// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Eigen's decomposition, compiled once: as a template in each of sixteen files it took a large part of their
// compilation.
#pragma once

#include <Eigen/Core>

namespace egocal::detail {

template <int n>
struct SymmetricEigen {
  Eigen::Matrix<double, n, 1> values;   ///< ascending
  Eigen::Matrix<double, n, n> vectors;  ///< columns of length 1, in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix, of which the lower triangle is read. Unspecified where
/// it is not finite. Compiled for n = 2, 3, 4, 5, 6, 8, 10 and Eigen::Dynamic (at most 10 x 10).
template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix);

/// The same without the vectors, for n = 8.
template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(const Eigen::Matrix<double, n, n>& matrix);

}  // namespace egocal::detail
