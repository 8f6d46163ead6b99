// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "linear_algebra/normal_equations.hpp"

#include <Eigen/Cholesky>

namespace egocal::detail {

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

}  // namespace egocal::detail
