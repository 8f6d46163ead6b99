// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/sqp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>

#include "egocal/problem/cost.hpp"
#include "solvers/tangent.hpp"

namespace egocal {

namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// -inv(H + shift I) g, or nothing where that is not positive definite or too nearly singular to be trusted.
bool newton_step(const Matrix6d& H, const Vector6d& g, double shift, Vector6d& x) {
  Matrix6d shifted = H;
  shifted.diagonal().array() += shift;
  const Eigen::LLT<Matrix6d> factor(shifted);
  if (factor.info() != Eigen::Success) return false;
  const auto pivots = factor.matrixLLT().diagonal();
  if (!(pivots.minCoeff() > 1e-6 * pivots.maxCoeff())) return false;
  x = factor.solve(-g);
  return true;
}

/// The step in the directions that have curvature; none where the cost is flat, so that an answer stays where
/// it is.
Vector6d truncated_step(const Matrix6d& H, const Vector6d& g) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(H);
  const double floor = 64 * epsilon * eigen.eigenvalues().cwiseAbs().maxCoeff();
  Vector6d x = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    const double curvature = std::abs(eigen.eigenvalues()[k]);
    if (curvature > floor) x -= eigen.eigenvectors().col(k).dot(g) / curvature * eigen.eigenvectors().col(k);
  }
  return x;
}

}  // namespace

Solution solve_sqp(const Matrix8d& Q_in, const DualQuaternion& start, const SqpOptions& options) {
  Solution solution;
  if (!Q_in.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return solution;
  }
  const double length = detail::length_scale(Q_in);
  const Matrix8d Q = detail::in_units_of(length, Q_in);
  DualQuaternion q = detail::in_units_of(length, normalized(start));
  if (!q.vec().allFinite()) q = {};
  double J = cost(Q, q);
  double shift = 0;
  solution.status = SolverStatus::iteration_limit;
  for (int i = 0; i < options.max_iterations; ++i) {
    solution.iterations = i + 1;
    // Newton on the KKT system of (18): on the constraints' tangent space the gradient is T' Q q and the
    // Hessian that of the Lagrangian (19), T' Z(lambda) T.
    const Vector8d v = q.vec();
    const Matrix86d T = detail::tangent_basis(q);
    const Matrix8d Z = lagrangian_matrix(Q, least_squares_multipliers(Q, q));
    const Matrix86d ZT = Z * T;
    const Matrix6d hessian = T.transpose() * ZT;
    const Vector6d gradient = ZT.transpose() * v;
    const double trace = hessian.diagonal().cwiseAbs().sum();
    if (!(trace > 0)) {
      solution.status = SolverStatus::degenerate;
      break;
    }
    const double rounding = 8 * epsilon * v.cwiseAbs().dot(Q.cwiseAbs() * v.cwiseAbs());
    Vector6d x;
    DualQuaternion next;
    double J_next = J;
    bool accepted = false;
    for (int attempt = 0; attempt < 40 && !accepted; ++attempt) {
      if (!newton_step(hessian, gradient, shift, x)) {
        if (attempt == 0 && shift == 0) {
          x = truncated_step(hessian, gradient);
        } else {
          shift = std::max(4 * shift, 1e-6 * trace);
          continue;
        }
      }
      next = detail::retract(q, x);
      J_next = cost(Q, next);
      accepted = J_next <= J + rounding;
      if (!accepted) shift = std::max(4 * shift, 1e-6 * trace);
    }
    if (!accepted) break;
    const double step = x.norm();
    const bool still = shift == 0 && J_next >= J - rounding;
    q = next;
    J = J_next;
    shift = shift < 1e-5 * trace ? 0 : shift / 16;
    // quadratic convergence: the error left is the square of this step; or nothing is gained any more
    if (shift == 0 && (step < 1e-9 || (still && step < 1e-6) || (still && i > 10))) {
      solution.status = SolverStatus::converged;
      break;
    }
  }
  solution.cost = cost(Q, q);
  solution.lambda = detail::in_units_of(1 / length, least_squares_multipliers(Q, q));
  solution.q = canonical_sign(detail::in_units_of(1 / length, q));
  return solution;
}

}  // namespace egocal
