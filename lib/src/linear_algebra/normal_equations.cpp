// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace egocal::detail {

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::VectorXd solve_in_units(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(A.rows());
  for (Eigen::Index i = 0; i < unit.size(); ++i)
    if (A(i, i) > 0) unit[i] = 1 / std::sqrt(A(i, i));
  Eigen::MatrixXd scaled = unit.asDiagonal() * A * unit.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  return unit.cwiseProduct(solve_symmetric(scaled, unit.cwiseProduct(b)).col(0));
}

}  // namespace egocal::detail
