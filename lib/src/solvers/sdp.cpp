// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/sdp.hpp"

#include <cmath>
#include <limits>

#include "egocal/problem/cost.hpp"
#include "egocal/solvers/sqp.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/lmi.hpp"

namespace egocal {
namespace {

/// (22) in the form of lmi.hpp: C = Q, y = lambda, <A_1, X> = |r|^2 = 1, <A_2, X> = -2 r.d = 0.
Lmi<8, 2> linear_matrix_inequality(const Matrix8d& Q) {
  Lmi<8, 2> lmi;
  lmi.C = Q;
  lmi.A[0].setZero();
  lmi.A[0].topLeftCorner<4, 4>().setIdentity();
  lmi.A[1].setZero();
  lmi.A[1].topRightCorner<4, 4>() = -Eigen::Matrix4d::Identity();
  lmi.A[1].bottomLeftCorner<4, 4>() = -Eigen::Matrix4d::Identity();
  lmi.b << 1, 0;
  return lmi;
}

/// The best dual part for a real part: min over d of J(r, d) subject to r.d = 0.
DualQuaternion with_best_dual(const Matrix8d& Q, const Eigen::Vector4d& r) {
  Eigen::Matrix<double, 5, 5> K = Eigen::Matrix<double, 5, 5>::Zero();
  K.topLeftCorner<4, 4>() = Q.bottomRightCorner<4, 4>();
  K.topRightCorner<4, 1>() = r;
  K.bottomLeftCorner<1, 4>() = r.transpose();
  Eigen::Matrix<double, 5, 1> right;
  right << -Q.bottomLeftCorner<4, 4>() * r, 0;
  // the shortest of all solutions, where D leaves a choice
  const detail::SymmetricEigen<5> eigen = detail::symmetric_eigen<5>(K);
  const double floor = 1e-14 * eigen.values.cwiseAbs().maxCoeff();
  Eigen::Matrix<double, 5, 1> solution = Eigen::Matrix<double, 5, 1>::Zero();
  for (int i = 0; i < 5; ++i) {
    const double value = eigen.values[i];
    if (std::abs(value) > floor) solution += eigen.vectors.col(i).dot(right) / value * eigen.vectors.col(i);
  }
  return normalized({r, solution.head<4>()});
}

/// An upper bound on J(q) in spite of the rounding of Q: where the cost is flat, a candidate kilometres away
/// may round to any cost, even a negative one.
double pessimistic_cost(const Matrix8d& Q, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  const Vector8d size = v.cwiseAbs();
  return v.dot(Q * v) + 4 * std::numeric_limits<double>::epsilon() * size.dot(Q.cwiseAbs() * size);
}

struct Best {
  DualQuaternion q;
  double cost = std::numeric_limits<double>::infinity();  ///< pessimistic

  void offer(const Matrix8d& Q, const DualQuaternion& candidate) {
    if (!candidate.vec().allFinite()) return;
    const double c = pessimistic_cost(Q, candidate);
    if (c < cost) *this = {candidate, c};
  }
  /// (31), with the constraints met exactly.
  void offer_null_vector(const Matrix8d& Q, const Vector8d& v) {
    if (v.head<4>().norm() > 1e-9 * v.norm()) offer(Q, normalized(DualQuaternion::from_vec(v)));
  }
};

/// (29) to (31). On noise-free motions the null space of Z holds (0, r) beside (r, d); g2 then picks the
/// combination u = v + s w with r_u . d_u = 0.
Best recover(const Matrix8d& Q, const Matrix8d& Z, const Matrix8d& X) {
  Best best;
  const detail::SymmetricEigen<8> null_space = detail::symmetric_eigen<8>(Z);
  const Vector8d v = null_space.vectors.col(0), w = null_space.vectors.col(1);
  best.offer_null_vector(Q, v);
  const auto g2 = [](const Vector8d& x, const Vector8d& y) { return x.head<4>().dot(y.tail<4>()); };
  const double a = g2(w, w), b = 0.5 * (g2(v, w) + g2(w, v)), c = g2(v, v);  // a s^2 + 2 b s + c = 0
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  for (const double numerator : {-b - root, -b + root}) {
    // s = numerator / a, homogeneous so that w alone is found too
    best.offer_null_vector(Q, a * v + numerator * w);
    best.offer_null_vector(Q, numerator * v + c * w);
  }
  // the primal matrix holds q q'; where more than one answer is optimal, one of them
  const detail::SymmetricEigen<4> rotation = detail::symmetric_eigen<4>(X.topLeftCorner<4, 4>());
  best.offer(Q, with_best_dual(Q, rotation.vectors.col(3)));
  return best;
}

}  // namespace

Solution solve_sdp(const Matrix8d& Q, const SdpOptions& options) {
  Solution solution;
  if (!Q.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return solution;
  }
  const double size_A = Q.topLeftCorner<4, 4>().trace();
  const double size_D = Q.bottomRightCorner<4, 4>().trace();
  if (!(size_A > std::numeric_limits<double>::min())) {
    solution.cost = cost(Q, solution.q);
    solution.status = SolverStatus::degenerate;
    return solution;
  }

  // The unit of length L makes both blocks of the same size, the unit of cost makes that size one.
  const double L = size_D > 1e-24 * size_A ? std::sqrt(size_A / size_D) : 1.0;
  Vector8d unit;
  unit << Eigen::Vector4d::Ones(), Eigen::Vector4d::Constant(L);
  const Matrix8d scaled = unit.asDiagonal() * (Q / size_A) * unit.asDiagonal();
  Lmi<8, 2> lmi = linear_matrix_inequality(scaled);
  // Without noise D is singular and no Z is positive definite: give the cone an inside, as wide as the
  // rounding of Q.
  lmi.C.bottomRightCorner<4, 4>() += 1e-14 * Eigen::Matrix4d::Identity();

  LmiPoint<8, 2> start;
  start.X = 0.25 * Matrix8d::Identity();
  start.Z = Matrix8d::Identity();
  start.y.setZero();
  const LmiResult<8, 2> result = solve_lmi(lmi, start, 2 * options.relative_gap, options.max_iterations);

  Best best =
      recover(scaled, lmi.C - result.point.y[0] * lmi.A[0] - result.point.y[1] * lmi.A[1], result.point.X);
  // An interior point ends where the gap drowns in rounding, at about the root of it in the argument. Newton
  // steps from there find the argument itself.
  best.q.dual *= L;
  const Solution polished = solve_sqp(Q, best.q);
  const double tolerance = 1e-13 * size_A;
  if (polished.q.vec().allFinite() &&
      pessimistic_cost(Q, polished.q) <= pessimistic_cost(Q, best.q) + tolerance) {
    best.q = polished.q;
  }

  solution.q = canonical_sign(normalized(best.q));
  solution.cost = cost(Q, solution.q);
  solution.lambda = {result.point.y[0] * size_A, result.point.y[1] * size_A / L};
  solution.iterations = result.iterations;
  solution.status = result.gap <= 1e-10 ? SolverStatus::converged : SolverStatus::iteration_limit;
  return solution;
}

}  // namespace egocal
