// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <type_traits>

namespace egocal::detail {

namespace {

/// A matrix of any size to 10, without memory from the heap: a type of its own for each size is 5 s of
/// compilation.
using UpToTen = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 10, 10>;

/// What every answer needs (4, 6), or compiles fast (3), is compiled for its size.
template <int n>
using Matrix = std::conditional_t<n == 3 || n == 4 || n == 6, Eigen::Matrix<double, n, n>, UpToTen>;

template <int size, int most>
using Column = Eigen::Matrix<double, size, 1, Eigen::ColMajor, most, 1>;

}  // namespace

}  // namespace egocal::detail

// Eigen applies 48 reflections and more in blocks, by its products of large matrices. There are nine at most
// here, so that this is never called: to compile it for each size took a third of this file.
#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)
#define EGOCAL_FEW_REFLECTIONS(Square, size, most)                                                       \
  template <>                                                                                            \
  template <>                                                                                            \
  inline void                                                                                            \
  Eigen::HouseholderSequence<Square, egocal::detail::Column<size == most ? size - 1 : size, most - 1>>:: \
      applyThisOnTheLeft(Square&, egocal::detail::Column<size, most>&, bool) const {                     \
    std::abort();                                                                                        \
  }
EGOCAL_FEW_REFLECTIONS(egocal::detail::Matrix<4>, 4, 4)
EGOCAL_FEW_REFLECTIONS(egocal::detail::Matrix<6>, 6, 6)
EGOCAL_FEW_REFLECTIONS(egocal::detail::UpToTen, Eigen::Dynamic, 10)
#undef EGOCAL_FEW_REFLECTIONS
#endif

namespace egocal::detail {

template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix) {
  const Matrix<n>& of_type = matrix;
  Eigen::SelfAdjointEigenSolver<Matrix<n>> eigen(matrix.rows());
  eigen.compute(of_type);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(const Eigen::Matrix<double, n, n>& matrix) {
  const Matrix<n>& of_type = matrix;
  return Eigen::SelfAdjointEigenSolver<Matrix<n>>(of_type, Eigen::EigenvaluesOnly).eigenvalues();
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
