// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/dual.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "certificate/proof.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/sqp.hpp"
#include "solvers/tangent.hpp"

namespace egocal {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// phi(m) and what belongs to it, in D's own axes and with lengths in units of `length`, where D is diagonal.
struct DualFunction {
  Matrix4d S0, S1;   ///< S(m) = S0 - m S1 - m^2 diag(inverse)
  Vector4d inverse;  ///< of D's eigenvalues
  Matrix4d B;
  Matrix4d U;  ///< D's eigenvectors
  double length = 1;
  double scale = 0;  ///< size of the numbers, for tolerances

  /// floor: of D's eigenvalues, in parts of the scale. Where rotations are nearly noise-free D is nearly
  /// singular; a floor keeps the elimination finite, and what it changes is repaired by Newton steps on the
  /// true Q.
  DualFunction(const Matrix8d& Q, double floor) {
    length = detail::length_scale(Q);
    const Matrix4d D = length * length * Q.bottomRightCorner<4, 4>();
    const Eigen::SelfAdjointEigenSolver<Matrix4d> eigen(D);
    U = eigen.eigenvectors();
    const Matrix4d A = U.transpose() * Q.topLeftCorner<4, 4>() * U;
    B.noalias() = length * U.transpose() * Q.topRightCorner<4, 4>() * U;
    scale = A.trace() + D.trace();
    inverse = eigen.eigenvalues().cwiseMax(floor * scale).cwiseInverse();
    const Matrix4d BD = B * inverse.asDiagonal();
    S0 = A;
    S0.noalias() -= BD * B.transpose();
    S1 = BD + BD.transpose();
  }

  Matrix4d at(double m) const {
    Matrix4d S = S0 - m * S1;
    S.diagonal() -= m * m * inverse;
    return S;
  }
  /// The d that minimises the Lagrangian for this r.
  Vector4d dual_part(const Vector4d& r, double m) const {
    return -inverse.cwiseProduct(B.transpose() * r + m * r);
  }
  DualQuaternion quaternion(const Vector4d& r, double m) const {
    return normalized({U * r, length * (U * dual_part(r, m))});
  }
};

/// Where phi has a kink its smallest eigenvalue is double, and the r in their span that has r'd = 0 is the
/// minimiser.
Vector4d orthogonal_combination(const DualFunction& phi, const Vector4d& r1, const Vector4d& r2, double m) {
  const double a = r1.dot(phi.dual_part(r1, m));
  const double c = r2.dot(phi.dual_part(r2, m));
  const double b = 0.5 * (r1.dot(phi.dual_part(r2, m)) + r2.dot(phi.dual_part(r1, m)));
  // a cos^2 + 2 b cos sin + c sin^2 = 0
  const double mean = 0.5 * (a + c);
  const double amplitude = std::hypot(0.5 * (a - c), b);
  if (!(amplitude > std::abs(mean))) return r1;
  const double phase = std::atan2(b, 0.5 * (a - c));
  const double angle = 0.5 * (phase + std::acos(-mean / amplitude));
  return std::cos(angle) * r1 + std::sin(angle) * r2;
}

/// Is no unit dual quaternion better than q by more than rounding?
bool proven_optimal(const Matrix8d& Q, const Solution& solution) {
  const double rounding = detail::rounding_of<8>(Q, solution.q.vec());
  return solution.cost <= rounding ||
         detail::proven_bound<8>(Q, solution.cost - 0.5 * rounding, solution.lambda.orthogonal, 0);
}

/// Safeguarded Newton ascent of the concave phi. Each time that less than `gain` (in parts of the scale) is
/// left to climb, Newton steps on the KKT system of the true Q start from there; true as soon as what they
/// reach is proven.
bool ascend(const Matrix8d& Q, const DualFunction& phi, double gain_enough, Solution& best) {
  double m = 0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    ++best.iterations;
    const Eigen::SelfAdjointEigenSolver<Matrix4d> eigen(phi.at(m));
    const double value = eigen.eigenvalues()[0];
    Vector4d r = eigen.eigenvectors().col(0);
    const double slope = 2 * r.dot(phi.dual_part(r, m));
    const Vector4d change = phi.S1 * r + 2 * m * phi.inverse.cwiseProduct(r);
    double curvature = 2 * r.dot(phi.inverse.cwiseProduct(r));
    for (int k = 1; k < 4; ++k) {
      const double coupling = eigen.eigenvectors().col(k).dot(change);
      curvature += 2 * coupling * coupling / std::max(eigen.eigenvalues()[k] - value, epsilon * phi.scale);
    }
    (slope > 0 ? low : high) = m;
    const bool pinned = high - low <= 4 * epsilon * std::max(std::abs(low), std::abs(high));
    const double gain = 0.5 * slope * slope / curvature;
    if (gain <= gain_enough * phi.scale || pinned) {
      if (pinned && gain > gain_enough * phi.scale)
        r = orthogonal_combination(phi, r, eigen.eigenvectors().col(1), m);
      Solution polished = solve_sqp(Q, phi.quaternion(r, m));
      if (polished.cost < best.cost) {
        polished.iterations = best.iterations;
        best = polished;
      }
      return proven_optimal(Q, best);
    }
    const double newton = m + slope / curvature;
    // a bracket that hardly shrinks is halved: the maximum is at a kink
    const bool stalling = std::isfinite(high - low) && i > 6 && i % 2 == 1;
    m = newton > low && newton < high && !stalling ? newton : 0.5 * (low + high);
  }
  return false;
}

}  // namespace

Solution solve_dual(const Matrix8d& Q) {
  Solution solution;
  if (!Q.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return solution;
  }
  if (!(Q.diagonal().maxCoeff() > 0)) {
    solution.status = SolverStatus::degenerate;
    return solution;
  }
  solution.cost = std::numeric_limits<double>::infinity();
  // The first attempt is nearly always the last. The others are for problems where Newton's basin is small or
  // D is nearly singular in a way that matters.
  constexpr struct {
    double floor, gain;
  } attempts[] = {{1e-9, 1e-4}, {1e-9, 1e-9}, {1e-12, 1e-12}, {1e-6, 1e-12}, {64 * epsilon, 1e-15}};
  for (const auto& attempt : attempts)
    if (ascend(Q, DualFunction(Q, attempt.floor), attempt.gain, solution)) return solution;
  return solution;
}

}  // namespace egocal
