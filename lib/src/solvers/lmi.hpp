// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace egocal {

/// A small dense semidefinite programme with N x N matrices and M multipliers:
///   primal  min <C, X>  subject to  <A_i, X> = b_i, X >= 0,
///   dual    max b . y   subject to  Z = C - sum y_i A_i >= 0.
/// All matrices symmetric, the A_i linearly independent.
template <int N, int M>
struct Lmi {
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, M, 1>;
  Matrix C = Matrix::Zero();
  std::array<Matrix, M> A{};
  Vector b = Vector::Zero();
};

/// X and Z positive definite; the equations need not hold at the start.
template <int N, int M>
struct LmiPoint {
  typename Lmi<N, M>::Matrix X, Z;
  typename Lmi<N, M>::Vector y;
};

template <int N, int M>
struct LmiResult {
  LmiPoint<N, M> point;
  double gap = 0;  ///< <X, Z>
  int iterations = 0;
  bool converged =
      false;  ///< gap and residuals below the tolerance; otherwise the last point before progress ended
};

/// Primal-dual path following (the HKM direction with Mehrotra's corrector). tolerance is absolute: scale C
/// to about one. Allocates nothing.
template <int N, int M>
LmiResult<N, M> solve_lmi(const Lmi<N, M>& lmi, const LmiPoint<N, M>& start, double tolerance,
                          int max_iterations) {
  using Matrix = typename Lmi<N, M>::Matrix;
  using Vector = typename Lmi<N, M>::Vector;
  using Square = Eigen::Matrix<double, M, M>;
  const auto inner = [](const Matrix& P, const Matrix& S) { return P.cwiseProduct(S).sum(); };
  const auto symmetric = [](const Matrix& P) -> Matrix { return 0.5 * (P + P.transpose()); };
  // the longest part of a step, at most all of it, that stays inside the cone with a margin
  const auto step_length = [](const Matrix& P, const Matrix& step) {
    constexpr double margin = 0.95;  // part of the way to the border of the cone, usual for interior points
    double alpha = 1;
    for (int i = 0; i < 60; ++i) {
      const Matrix probe = P + alpha * step;
      if (probe.llt().info() == Eigen::Success) return alpha == 1 ? 1.0 : margin * alpha;
      alpha *= 0.8;
    }
    return 0.0;
  };

  LmiResult<N, M> result;
  result.point = start;
  LmiPoint<N, M>& p = result.point;
  for (; result.iterations < max_iterations; ++result.iterations) {
    Matrix dual_residual = lmi.C - p.Z;
    Vector primal_residual = lmi.b;
    for (int i = 0; i < M; ++i) {
      dual_residual -= p.y[i] * lmi.A[std::size_t(i)];
      primal_residual[i] -= inner(lmi.A[std::size_t(i)], p.X);
    }
    result.gap = inner(p.X, p.Z);
    if (result.gap <= tolerance && dual_residual.norm() <= 1e-12 &&
        primal_residual.norm() <= 1e-9 * (1 + p.X.norm())) {
      result.converged = true;
      break;
    }
    const double mu = result.gap / N;

    const Eigen::LLT<Matrix> factor(p.Z);
    if (factor.info() != Eigen::Success) break;
    const Matrix inverse = symmetric(factor.solve(Matrix::Identity()));
    Square schur;
    for (int j = 0; j < M; ++j) {
      const Matrix product = symmetric(inverse * lmi.A[std::size_t(j)] * p.X);
      for (int i = 0; i <= j; ++i) schur(i, j) = schur(j, i) = inner(lmi.A[std::size_t(i)], product);
    }
    const Eigen::LDLT<Square> schur_factor(schur);
    if (schur_factor.info() != Eigen::Success) break;

    // dX + inverse dZ X = target; dZ = dual_residual - sum dy_i A_i
    const auto direction = [&](const Matrix& target, Vector& dy, Matrix& dX, Matrix& dZ) {
      const Matrix known = symmetric(target - inverse * dual_residual * p.X);
      Vector right = primal_residual;
      for (int i = 0; i < M; ++i) right[i] -= inner(lmi.A[std::size_t(i)], known);
      dy = schur_factor.solve(right);
      dZ = dual_residual;
      for (int i = 0; i < M; ++i) dZ -= dy[i] * lmi.A[std::size_t(i)];
      dX = symmetric(target - inverse * dZ * p.X);
    };

    Vector dy;
    Matrix dX, dZ;
    direction(-p.X, dy, dX, dZ);  // predictor: straight for the optimum
    const double ahead_X = step_length(p.X, dX), ahead_Z = step_length(p.Z, dZ);
    const double predicted = inner(p.X + ahead_X * dX, p.Z + ahead_Z * dZ) / N;
    const double ratio = std::clamp(predicted / mu, 0.0, 1.0);
    const double centring = std::max(1e-6, ratio * ratio * ratio);
    direction(centring * mu * inverse - p.X - inverse * dZ * dX, dy, dX, dZ);

    double alpha_X = step_length(p.X, dX), alpha_Z = step_length(p.Z, dZ);
    if (!(dX.allFinite() && dZ.allFinite() && dy.allFinite()) || (alpha_X < 1e-8 && alpha_Z < 1e-8)) break;
    p.X = symmetric(p.X + alpha_X * dX);
    p.Z = symmetric(p.Z + alpha_Z * dZ);
    p.y += alpha_Z * dy;
  }
  return result;
}

}  // namespace egocal
