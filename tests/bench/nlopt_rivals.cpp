// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "nlopt_rivals.hpp"

#include <nlopt.h>

namespace egocal::bench {

namespace {

template <int N>
double objective(unsigned, const double* x, double* gradient, void* data) {
  const auto& Q = *static_cast<const Eigen::Matrix<double, N, N>*>(data);
  const Eigen::Map<const Eigen::Matrix<double, N, 1>> q(x);
  const Eigen::Matrix<double, N, 1> Qq = Q * q;
  if (gradient) Eigen::Map<Eigen::Matrix<double, N, 1>>{gradient} = 2 * Qq;
  return q.dot(Qq);
}

void constraints(unsigned, double* g, unsigned, const double* x, double* gradient, void*) {
  g[0] = 1;
  g[1] = 0;
  for (int i = 0; i < 4; ++i) {
    g[0] -= x[i] * x[i];
    g[1] += 2 * x[i] * x[i + 4];
    if (gradient) {
      gradient[i] = -2 * x[i];
      gradient[i + 4] = 0;
      gradient[i + 8] = 2 * x[i + 4];
      gradient[i + 12] = 2 * x[i];
    }
  }
}

double planar_constraint(unsigned, const double* x, double* gradient, void*) {
  if (gradient) {
    gradient[0] = -2 * x[0];
    gradient[1] = -2 * x[1];
    gradient[2] = gradient[3] = 0;
  }
  return 1 - x[0] * x[0] - x[1] * x[1];
}

constexpr double tolerance = 1e-8;

void limits(nlopt_opt opt, double relative_tolerance = 1e-14) {
  nlopt_set_ftol_rel(opt, relative_tolerance);
  nlopt_set_maxeval(opt, 1000);
}

DualQuaternion solve_spatial(const Matrix8d& Q, const DualQuaternion& start, nlopt_opt opt,
                             double relative_tolerance) {
  nlopt_set_min_objective(opt, objective<8>, const_cast<Matrix8d*>(&Q));
  const double tolerances[2] = {tolerance, tolerance};
  nlopt_add_equality_mconstraint(opt, 2, constraints, nullptr, tolerances);
  limits(opt, relative_tolerance);
  Vector8d x = start.vec();
  double minimum;
  nlopt_optimize(opt, x.data(), &minimum);
  nlopt_destroy(opt);
  return normalized(DualQuaternion::from_vec(x));
}

}  // namespace

DualQuaternion nlopt_slsqp(const Matrix8d& Q, const DualQuaternion& start) {
  return solve_spatial(Q, start, nlopt_create(NLOPT_LD_SLSQP, 8), 1e-14);
}

DualQuaternion nlopt_augmented_lagrangian(const Matrix8d& Q, const DualQuaternion& start) {
  nlopt_opt opt = nlopt_create(NLOPT_AUGLAG, 8);
  nlopt_opt inner = nlopt_create(NLOPT_LD_TNEWTON_PRECOND, 8);
  constexpr double fastest = 1e-8;  // tighter takes twice as long, looser is no faster
  limits(inner, fastest);
  nlopt_set_local_optimizer(opt, inner);
  nlopt_destroy(inner);
  return solve_spatial(Q, start, opt, fastest);
}

DualQuaternion nlopt_planar(const Matrix8d& Q_planar, const DualQuaternion& start) {
  constexpr int kept[4] = {0, 3, 5, 6};
  Eigen::Matrix4d Q;
  Eigen::Vector4d x;
  const Vector8d v = start.vec();
  for (int i = 0; i < 4; ++i) {
    x[i] = v[kept[i]];
    for (int j = 0; j < 4; ++j) Q(i, j) = Q_planar(kept[i], kept[j]);
  }
  nlopt_opt opt = nlopt_create(NLOPT_LD_SLSQP, 4);
  nlopt_set_min_objective(opt, objective<4>, &Q);
  nlopt_add_equality_constraint(opt, planar_constraint, nullptr, tolerance);
  limits(opt);
  double minimum;
  nlopt_optimize(opt, x.data(), &minimum);
  nlopt_destroy(opt);
  Vector8d full = Vector8d::Zero();
  for (int i = 0; i < 4; ++i) full[kept[i]] = x[i];
  return normalized(DualQuaternion::from_vec(full));
}

}  // namespace egocal::bench
