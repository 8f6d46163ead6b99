// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Eigen's factors of a symmetric matrix of few unknowns, compiled once: in each of seven files they took a
// third of its compilation.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace egocal::detail {

using UpToSix = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using SquareUpToSix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// LDL' with pivots of a symmetric matrix, of which the lower triangle is read.
class SmallFactor {
 public:
  explicit SmallFactor(const SquareUpToSix& matrix);
  /// Whether the factored matrix is positive semidefinite, of finite numbers.
  bool positive() const;
  UpToSix solve(const UpToSix& right) const;
  SquareUpToSix solve(const SquareUpToSix& right) const;

 private:
  Eigen::LDLT<SquareUpToSix> factor_;
};

}  // namespace egocal::detail
