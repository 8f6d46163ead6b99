// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What a user of the installed library writes.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstdio>

#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/simulation/simulation.hpp"
#include "egocal/solvers/global.hpp"

// Eigen's code for 4 x 4 matrices, compiled with this project's flags, beside the library's.
double least_eigenvalue(const Eigen::Matrix4d& M) {
  const Eigen::Matrix4d inverse = M.llt().solve(Eigen::Matrix4d::Identity());
  return 1 / Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(inverse).eigenvalues()[3];
}

int main() {
  egocal::SimulationOptions options;
  options.T_vehicle_sensor = {egocal::Pose{}, {egocal::rotation_exp({0.1, 0.2, 0.3}), {1, 2, 3}}};
  const auto trajectories = egocal::simulate(options);
  egocal::Statistics statistics;
  for (std::size_t i = 1; i < trajectories[0].size(); ++i)
    statistics.add(conjugate(trajectories[0][i - 1].pose) * trajectories[0][i].pose,
                   conjugate(trajectories[1][i - 1].pose) * trajectories[1][i].pose);
  const egocal::Matrix8d Q = egocal::cost_matrix(statistics);
  const egocal::Solution solution = egocal::solve_dual(Q);
  if (!(least_eigenvalue(egocal::Matrix8d(Q).bottomRightCorner<4, 4>()) > 0)) std::printf("D is singular\n");
  const egocal::Certificate certificate = egocal::verify(Q, solution.q);
  const auto error =
      egocal::extrinsic_error(egocal::to_dual_quaternion(options.T_vehicle_sensor[1]), solution.q);
  std::printf("%g m, %g rad\n", error.translation, error.rotation);
  return certificate.optimality == egocal::Optimality::certified && error.translation < 1e-9 ? 0 : 1;
}
