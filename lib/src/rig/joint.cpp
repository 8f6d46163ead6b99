// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/joint.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "egocal/problem/cost.hpp"

namespace egocal::detail {

namespace {

using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;  // never on the heap
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;

/// A displacement (u, v) of sensor a as sensor b sees it: the imaginary parts of q^-1 (u + eps v) q.
Block adjoint(const DualQuaternion& q) {
  Block A(6, 6);
  for (int i = 0; i < 6; ++i) {
    DualQuaternion x{QuaternionVector::Zero(), QuaternionVector::Zero()};
    (i < 3 ? x.real : x.dual)[i % 3 + 1] = 1;
    const DualQuaternion y = conjugate(q) * x * q;
    for (int k = 0; k < 3; ++k) {
      A(k, i) = y.real[k + 1];
      A(k + 3, i) = y.dual[k + 1];
    }
  }
  return A;
}

/// [g]x of three elements.
void add_cross(Block& M, int row, int column, const Unknowns& g, int first) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    M(row + j, column + k) -= g[first + i];
    M(row + k, column + j) += g[first + i];
  }
}

/// The product of both displacements moves the pair by -(a x u, a x v + w x u): second order, times g.
Block second_order(const Unknowns& g) {
  Block M = Block::Zero(6, 6);
  add_cross(M, 0, 0, g, 0);
  add_cross(M, 0, 3, g, 3);
  add_cross(M, 3, 0, g, 3);
  return M;
}

Eigen::VectorXd downhill_step(const JointDerivatives& here, const JointOptions& options) {
  const double size = here.hessian.diagonal().cwiseAbs().maxCoeff();
  for (double raise = 0;
       raise<options.most_raise; raise = raise> 0 ? options.raise_factor * raise : options.first_raise) {
    Eigen::MatrixXd H = here.hessian;
    H.diagonal().array() += raise * size;
    const Eigen::LLT<Eigen::MatrixXd> factor(H);
    if (factor.info() != Eigen::Success) continue;
    Eigen::VectorXd step = -factor.solve(here.gradient);
    if (step.allFinite()) return step;
  }
  return {};
}

}  // namespace

JointPair joint_pair(const RigEdge& edge, double length) {
  const Matrix8d symmetric = 0.5 * (edge.Q + edge.Q.transpose());
  return {edge.a, edge.b, in_units_of(length, symmetric), {}};
}

double minimum_of(const JointPair& pair) {
  constexpr double least_minimum = 1e-14;  // of the trace: what rounding leaves of perfect motions
  return std::max(cost(pair.Q, pair.optimum), least_minimum * pair.Q.trace());
}

double joint_cost(std::span<const JointPair> pairs, const std::vector<DualQuaternion>& poses) {
  double sum = 0;
  for (const JointPair& pair : pairs) sum += cost(pair.Q, relative(poses[pair.a], poses[pair.b]));
  return sum;
}

JointDerivatives joint_derivatives(std::span<const JointPair> pairs,
                                   const std::vector<DualQuaternion>& poses) {
  const auto size = static_cast<Eigen::Index>(6 * (poses.size() - 1));
  JointDerivatives result{Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  const auto at = [](std::size_t sensor) { return static_cast<Eigen::Index>(6 * (sensor - 1)); };
  for (const JointPair& pair : pairs) {
    const DualQuaternion q = relative(poses[pair.a], poses[pair.b]);
    const Block T = tangent_basis(q);
    const Block Z = lagrangian_matrix(pair.Q, least_squares_multipliers(pair.Q, q));
    const Unknowns v = q.vec();
    const Block Q = pair.Q;
    const Unknowns g = T.transpose() * (Q * v);
    const Block H = T.transpose() * (Z * T);
    // x of the pair is x_b - A x_a, to first order
    const Block A = adjoint(q);
    if (pair.b > 0) {
      result.gradient.segment(at(pair.b), 6) += g;
      result.hessian.block(at(pair.b), at(pair.b), 6, 6) += H;
    }
    if (pair.a > 0) {
      result.gradient.segment(at(pair.a), 6) -= A.transpose() * g;
      result.hessian.block(at(pair.a), at(pair.a), 6, 6) += A.transpose() * (H * A);
    }
    if (pair.a > 0 && pair.b > 0) {
      const Block mixed = A.transpose() * (second_order(g) - H);
      result.hessian.block(at(pair.a), at(pair.b), 6, 6) += mixed;
      result.hessian.block(at(pair.b), at(pair.a), 6, 6) += mixed.transpose();
    }
  }
  return result;
}

namespace {

std::vector<DualQuaternion> moved(const std::vector<DualQuaternion>& poses, const Eigen::VectorXd& step) {
  std::vector<DualQuaternion> next = poses;
  for (std::size_t i = 1; i < poses.size(); ++i)
    next[i] = retract(poses[i], step.segment(static_cast<Eigen::Index>(6 * (i - 1)), 6));
  return next;
}

}  // namespace

std::vector<DualQuaternion> minimise_joint(std::span<const JointPair> pairs,
                                           std::vector<DualQuaternion> poses, const JointOptions& options) {
  if (poses.size() < 2) return poses;
  double best = joint_cost(pairs, poses);
  JointDerivatives here = joint_derivatives(pairs, poses);
  for (int iteration = 0; iteration < options.most_iterations; ++iteration) {
    const Eigen::VectorXd step = downhill_step(here, options);
    if (step.size() == 0) return poses;
    bool lower = false;
    double part = 1;
    for (int halving = 0; halving < options.most_halvings && !lower; ++halving, part *= 0.5) {
      std::vector<DualQuaternion> next = moved(poses, part * step);
      const double value = joint_cost(pairs, next);
      if (!(value < best)) continue;
      best = value;
      poses = std::move(next);
      lower = true;
    }
    if (!lower) {
      // below what the cost shows, the gradient decides
      std::vector<DualQuaternion> next = moved(poses, step);
      return joint_derivatives(pairs, next).gradient.norm() < here.gradient.norm() ? next : poses;
    }
    here = joint_derivatives(pairs, poses);
    if (step.norm() < options.least_step) return poses;
  }
  return poses;
}

}  // namespace egocal::detail
