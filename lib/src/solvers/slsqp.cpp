// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/slsqp.hpp"

#include <nlopt.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <memory>

#include "egocal/problem/cost.hpp"
#include "egocal/solvers/sqp.hpp"

namespace egocal {
namespace {

struct Deleter {
  void operator()(nlopt_opt_s* opt) const { nlopt_destroy(opt); }
};
using Optimizer = std::unique_ptr<nlopt_opt_s, Deleter>;

template <int N>
struct Quadratic {
  Eigen::Matrix<double, N, N> Q;
};

template <int N>
double objective(unsigned, const double* x, double* gradient, void* data) {
  const auto& Q = static_cast<const Quadratic<N>*>(data)->Q;
  const Eigen::Map<const Eigen::Matrix<double, N, 1>> q(x);
  const Eigen::Matrix<double, N, 1> Qq = Q * q;
  if (gradient) Eigen::Map<Eigen::Matrix<double, N, 1>>{gradient} = 2 * Qq;
  return q.dot(Qq);
}

/// g1, g2 of (17) and their gradients, row by row.
void unit_dual_quaternion(unsigned, double* g, unsigned, const double* x, double* gradient, void*) {
  const Eigen::Map<const Eigen::Vector4d> r(x), d(x + 4);
  g[0] = 1 - r.squaredNorm();
  g[1] = 2 * r.dot(d);
  if (gradient) {
    Eigen::Map<Eigen::Matrix<double, 2, 8, Eigen::RowMajor>> J(gradient);
    J << -2 * r.transpose(), Eigen::RowVector4d::Zero(), 2 * d.transpose(), 2 * r.transpose();
  }
}

/// g1 of the planar variables q1, q4, q6, q7; g2 and (26) hold by themselves.
double unit_planar(unsigned, const double* x, double* gradient, void*) {
  if (gradient) {
    gradient[0] = -2 * x[0];
    gradient[1] = -2 * x[1];
    gradient[2] = gradient[3] = 0;
  }
  return 1 - x[0] * x[0] - x[1] * x[1];
}

/// Whether NLopt can take the numbers (a NaN makes it loop for ever), and units in which they are near one:
/// trace(A) for the cost, and a length that makes trace(D) as large.
struct Units {
  double cost = 0, length = 1;
};
template <int N>
Units units(const Eigen::Matrix<double, N, N>& Q) {
  Units u;
  u.cost = Q.template topLeftCorner<N / 2, N / 2>().trace();
  const double size_D = Q.template bottomRightCorner<N / 2, N / 2>().trace();
  if (size_D > 1e-24 * u.cost) u.length = std::sqrt(u.cost / size_D);
  return u;
}

template <int N>
struct LocalMinimum {
  Eigen::Matrix<double, N, 1> x;
  SolverStatus status = SolverStatus::converged;
  int evaluations = 0;
};

/// add_constraints(opt) returns NLopt's result code.
template <int N, typename AddConstraints>
LocalMinimum<N> minimise(const Eigen::Matrix<double, N, N>& Q, const Units& unit,
                         const Eigen::Matrix<double, N, 1>& start, const SlsqpOptions& options,
                         AddConstraints add_constraints) {
  Eigen::Matrix<double, N, 1> scale;
  scale << Eigen::Matrix<double, N / 2, 1>::Ones(), Eigen::Matrix<double, N / 2, 1>::Constant(unit.length);
  Quadratic<N> scaled{scale.asDiagonal() * (Q / unit.cost) * scale.asDiagonal()};

  LocalMinimum<N> result;
  result.x = start;
  const Optimizer opt(nlopt_create(NLOPT_LD_SLSQP, N));
  const bool ready = opt && nlopt_set_min_objective(opt.get(), objective<N>, &scaled) > 0 &&
                     add_constraints(opt.get()) > 0 &&
                     nlopt_set_ftol_rel(opt.get(), options.relative_tolerance) > 0 &&
                     nlopt_set_ftol_abs(opt.get(), options.absolute_tolerance) > 0 &&
                     nlopt_set_maxeval(opt.get(), options.max_evaluations) > 0 &&
                     nlopt_set_maxtime(opt.get(), options.max_seconds) > 0;
  if (!ready) {
    result.status = SolverStatus::degenerate;
    return result;
  }
  Eigen::Matrix<double, N, 1> x = start.cwiseQuotient(scale);
  double minimum = 0;
  const nlopt_result code = nlopt_optimize(opt.get(), x.data(), &minimum);
  result.evaluations = nlopt_get_numevals(opt.get());
  if (!x.allFinite()) {
    result.status = SolverStatus::degenerate;
    return result;
  }
  result.x = x.cwiseProduct(scale);
  // NLOPT_ROUNDOFF_LIMITED ends a start at the solution and many good answers, so the point decides
  if (code == NLOPT_MAXEVAL_REACHED || code == NLOPT_MAXTIME_REACHED) {
    result.status = SolverStatus::iteration_limit;
  } else if (code < 0 && code != NLOPT_ROUNDOFF_LIMITED) {
    result.status = SolverStatus::degenerate;
  }
  return result;
}

/// Newton on the KKT system of the planar problem, (Q - lambda P) x = 0 with P = diag(1, 1, 0, 0) and x'P x
/// = 1.
Eigen::Vector4d finished_planar(const Eigen::Matrix4d& Q, const Eigen::Vector4d& start, double length,
                                double finish) {
  Eigen::Vector4d x = start;
  for (int i = 0; i < 3; ++i) {
    x.head<2>().normalize();
    const Eigen::Vector4d Px(x[0], x[1], 0, 0);
    const double lambda = x.dot(Q * x);
    Eigen::Matrix<double, 5, 5> K = Eigen::Matrix<double, 5, 5>::Zero();
    K.topLeftCorner<4, 4>() = Q;
    K(0, 0) -= lambda;
    K(1, 1) -= lambda;
    K.topRightCorner<4, 1>() = Px;
    K.bottomLeftCorner<1, 4>() = Px.transpose();
    Eigen::Matrix<double, 5, 1> right;
    right << lambda * Px - Q * x, 0;
    const Eigen::FullPivLU<Eigen::Matrix<double, 5, 5>> factor(K);
    if (factor.rank() < 5) break;
    const Eigen::Vector4d step = factor.solve(right).head<4>();
    if (!(step.head<2>().norm() < finish && step.tail<2>().norm() < finish * length)) break;
    x += step;
  }
  x.head<2>().normalize();
  return x.allFinite() ? x : start;
}

/// Projects on the constraints; returns the start if the numbers allow nothing better.
Solution finished(const Matrix8d& Q, const DualQuaternion& start, const DualQuaternion& found,
                  SolverStatus status, int evaluations) {
  Solution solution;
  solution.status = status;
  solution.iterations = evaluations;
  const DualQuaternion projected = normalized(found);
  const bool usable = projected.vec().allFinite() && found.real.norm() > 0.5 &&
                      constraints(projected).norm() < 1e-9 * (1 + projected.dual.norm());
  if (!usable) solution.status = SolverStatus::degenerate;
  solution.q = canonical_sign(usable ? projected : start);
  solution.cost = cost(Q, solution.q);
  solution.lambda = least_squares_multipliers(Q, solution.q);
  return solution;
}

Solution refused(const Matrix8d& Q, const DualQuaternion& start, SolverStatus status) {
  Solution solution;
  solution.status = status;
  if (status == SolverStatus::not_finite) return solution;
  solution.q = start;
  solution.cost = cost(Q, start);
  return solution;
}

DualQuaternion unit_start(const DualQuaternion& start) {
  const DualQuaternion unit = canonical_sign(normalized(start));
  return unit.vec().allFinite() ? unit : DualQuaternion{};
}

}  // namespace

Solution solve_slsqp(const Matrix8d& Q, const DualQuaternion& start, const SlsqpOptions& options) {
  const DualQuaternion begin = unit_start(start);
  if (!Q.allFinite()) return refused(Q, begin, SolverStatus::not_finite);
  const Units unit = units<8>(Q);
  if (!(unit.cost > std::numeric_limits<double>::min())) return refused(Q, begin, SolverStatus::degenerate);

  const LocalMinimum<8> minimum = minimise<8>(Q, unit, begin.vec(), options, [&options](nlopt_opt opt) {
    const double tolerances[2] = {options.constraint_tolerance, options.constraint_tolerance};
    return nlopt_add_equality_mconstraint(opt, 2, unit_dual_quaternion, nullptr, tolerances);
  });
  Solution solution =
      finished(Q, begin, DualQuaternion::from_vec(minimum.x), minimum.status, minimum.evaluations);
  const Solution newton = solve_sqp(Q, solution.q, {.max_iterations = 4});
  const Vector8d step = newton.q.vec() - solution.q.vec();
  const bool near =
      step.head<4>().norm() < options.finish && step.tail<4>().norm() < options.finish * unit.length;
  if (near && newton.cost <= solution.cost + 1e-14 * unit.cost) {
    solution.q = newton.q;
    solution.cost = newton.cost;
    solution.lambda = newton.lambda;
  }
  return solution;
}

Solution solve_slsqp_planar(const Matrix8d& Q_planar, const DualQuaternion& start,
                            const SlsqpOptions& options) {
  constexpr int variables[4] = {0, 3, 5, 6};  // q1, q4, q6, q7 of (26)
  DualQuaternion begin = unit_start(start);
  begin.real[1] = begin.real[2] = begin.dual[0] = begin.dual[3] = 0;
  begin = unit_start(begin);
  if (!Q_planar.allFinite()) return refused(Q_planar, begin, SolverStatus::not_finite);
  Eigen::Matrix4d Q;
  Eigen::Vector4d x;
  const Vector8d v = begin.vec();
  for (int i = 0; i < 4; ++i) {
    x[i] = v[variables[i]];
    for (int j = 0; j < 4; ++j) Q(i, j) = Q_planar(variables[i], variables[j]);
  }
  const Units unit = units<4>(Q);
  if (!(unit.cost > std::numeric_limits<double>::min()))
    return refused(Q_planar, begin, SolverStatus::degenerate);

  const LocalMinimum<4> minimum = minimise<4>(Q, unit, x, options, [&options](nlopt_opt opt) {
    return nlopt_add_equality_constraint(opt, unit_planar, nullptr, options.constraint_tolerance);
  });
  Vector8d found = Vector8d::Zero();
  const Eigen::Vector4d last = finished_planar(Q, minimum.x, unit.length, options.finish);
  for (int i = 0; i < 4; ++i) found[variables[i]] = last[i];
  return finished(Q_planar, begin, DualQuaternion::from_vec(found), minimum.status, minimum.evaluations);
}

}  // namespace egocal
