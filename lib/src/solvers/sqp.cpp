// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/sqp.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "egocal/problem/cost.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/newton.hpp"

namespace egocal {

namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::Vector6d;

/// The lower Cholesky factor in place of a matrix, of which the lower triangle is read. False: it is not
/// positive definite. The bits are those of Eigen::LLT, which takes longer: it also adds up all columns for a
/// norm that is not used here, and its loops do not know the size.
bool cholesky(Matrix6d& A) {
  for (int k = 0; k < 6; ++k) {
    double pivot = A(k, k);
    if (k > 0) {
      double square = A(k, 0) * A(k, 0);
      for (int j = 1; j < k; ++j) square += A(k, j) * A(k, j);
      pivot -= square;
    }
    if (pivot <= 0) return false;
    A(k, k) = pivot = std::sqrt(pivot);
    for (int i = k + 1; i < 6; ++i) {
      double known = 0;
      for (int j = 0; j < k; ++j) known += A(i, j) * A(k, j);
      A(i, k) = (A(i, k) - known) / pivot;
    }
  }
  return true;
}

/// -inv(H + shift I) g, or nothing where that is not positive definite or too nearly singular to be trusted.
bool newton_step(const Matrix6d& H, const Vector6d& g, double shift, Vector6d& x) {
  Matrix6d L = H;
  L.diagonal().array() += shift;
  if (!cholesky(L)) return false;
  const auto pivots = L.diagonal();
  if (!(pivots.minCoeff() > 1e-6 * pivots.maxCoeff())) return false;
  x = -g;
  L.triangularView<Eigen::Lower>().solveInPlace(x);
  L.triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
  return true;
}

/// The step in the directions that have curvature; none where the cost is flat, so that an answer stays where
/// it is.
Vector6d truncated_step(const Matrix6d& H, const Vector6d& g) {
  const detail::SymmetricEigen<6> eigen = detail::symmetric_eigen<6>(H);
  const double floor = 64 * std::numeric_limits<double>::epsilon() * eigen.values.cwiseAbs().maxCoeff();
  Vector6d x = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    const double curvature = std::abs(eigen.values[k]);
    if (curvature > floor) x -= eigen.vectors.col(k).dot(g) / curvature * eigen.vectors.col(k);
  }
  return x;
}

}  // namespace

namespace detail {

Solution newton_on_kkt(const Matrix8d& Q, const DualQuaternion& start, int max_iterations) {
  Solution solution;
  DualQuaternion q = normalized(start);
  if (!q.vec().allFinite()) q = {};
  Vector8d v = q.vec();
  Vector8d Qv = Q.lazyProduct(v);
  double J = v.dot(Qv);
  const Matrix8d absolute = Q.cwiseAbs();
  double shift = 0;
  solution.status = SolverStatus::iteration_limit;
  for (int i = 0; i < max_iterations; ++i) {
    solution.iterations = i + 1;
    // On the constraints' tangent space the gradient of J is T'Qq and the Hessian of the Lagrangian (19) is
    // T'ZT.
    const Matrix86d T = tangent_basis(q);
    const Multipliers lambda = least_squares_multipliers(q, Qv);
    Matrix86d ZT = Q.lazyProduct(T);  // small: not worth packing into blocks
    ZT.topRows<4>() += lambda.orthogonal * T.bottomRows<4>() - lambda.norm * T.topRows<4>();
    ZT.bottomRows<4>() += lambda.orthogonal * T.topRows<4>();
    const Matrix6d hessian = T.transpose().lazyProduct(ZT);
    const Vector6d gradient = T.transpose().lazyProduct(Qv);
    const double trace = hessian.diagonal().cwiseAbs().sum();
    if (!(trace > 0)) {
      solution.status = SolverStatus::degenerate;
      break;
    }
    const double rounding =
        8 * std::numeric_limits<double>::epsilon() * v.cwiseAbs().dot(absolute * v.cwiseAbs());
    Vector6d x;
    DualQuaternion next;
    Vector8d v_next, Qv_next;
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
      next = retract(q, x);
      v_next = next.vec();
      Qv_next = Q.lazyProduct(v_next);
      J_next = v_next.dot(Qv_next);
      accepted = J_next <= J + rounding;
      if (!accepted) shift = std::max(4 * shift, 1e-6 * trace);
    }
    if (!accepted) break;
    const double step = x.norm();
    const bool still = shift == 0 && J_next >= J - rounding;
    q = next;
    v = v_next;
    Qv = Qv_next;
    J = J_next;
    shift = shift < 1e-5 * trace ? 0 : shift / 16;
    // quadratic convergence: the error left is the square of this step; or nothing is gained any more
    if (shift == 0 && (step < 1e-8 || (still && step < 1e-6) || (still && i > 10))) {
      solution.status = SolverStatus::converged;
      break;
    }
  }
  solution.q = canonical_sign(q);
  solution.cost = J;
  solution.lambda = least_squares_multipliers(q, Qv);
  return solution;
}

}  // namespace detail

Solution solve_sqp(const Matrix8d& Q, const DualQuaternion& start, const SqpOptions& options) {
  Solution solution;
  if (!Q.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return solution;
  }
  const double length = detail::length_scale(Q);
  solution = detail::newton_on_kkt(detail::in_units_of(length, Q), detail::in_units_of(length, start),
                                   options.max_iterations);
  solution.q = detail::in_units_of(1 / length, solution.q);
  solution.lambda = detail::in_units_of(1 / length, solution.lambda);
  return solution;
}

}  // namespace egocal
