// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace egocal::detail {

template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(const Eigen::Matrix<double, n, n>& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

template SymmetricEigen<2> symmetric_eigen<2>(const Eigen::Matrix<double, 2, 2>&);
template SymmetricEigen<3> symmetric_eigen<3>(const Eigen::Matrix<double, 3, 3>&);
template SymmetricEigen<4> symmetric_eigen<4>(const Eigen::Matrix<double, 4, 4>&);
template SymmetricEigen<5> symmetric_eigen<5>(const Eigen::Matrix<double, 5, 5>&);
template SymmetricEigen<6> symmetric_eigen<6>(const Eigen::Matrix<double, 6, 6>&);
template SymmetricEigen<8> symmetric_eigen<8>(const Eigen::Matrix<double, 8, 8>&);
template SymmetricEigen<10> symmetric_eigen<10>(const Eigen::Matrix<double, 10, 10>&);
template SymmetricEigen<Eigen::Dynamic> symmetric_eigen<Eigen::Dynamic>(const Eigen::MatrixXd&);
template Eigen::Matrix<double, 8, 1> symmetric_eigenvalues<8>(const Eigen::Matrix<double, 8, 8>&);

}  // namespace egocal::detail
