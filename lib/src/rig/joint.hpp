// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "egocal/rig/rig.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// One pair of the joint problem, lengths in a common unit.
struct JointPair {
  std::size_t a = 0, b = 0;  ///< a < b
  Matrix8d Q;                ///< symmetric; divided by the pair's minimum, so that noisy pairs count less
  DualQuaternion optimum;    ///< of this pair alone
};

/// An edge with lengths in another unit, without its optimum.
JointPair joint_pair(const RigEdge& edge, double length);

/// The cost of a pair at its optimum. Motions without noise have none to divide by: a part of the trace.
double minimum_of(const JointPair& pair);

/// T_a_b of two poses in sensor 0.
inline DualQuaternion relative(const DualQuaternion& a, const DualQuaternion& b) {
  return canonical_sign(normalized(conjugate(a) * b));
}

double joint_cost(std::span<const JointPair> pairs, const std::vector<DualQuaternion>& poses);

/// Half the gradient and half the Hessian over (x_1, ..., x_n), pose i moving to q_i (1 + x_i); sensor 0
/// stays.
struct JointDerivatives {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};
JointDerivatives joint_derivatives(std::span<const JointPair> pairs,
                                   const std::vector<DualQuaternion>& poses);

/// Newton's method for the joint minimum. Study: tests/bench/rig_study.cpp.
struct JointOptions {
  /// Far from the minimum the Hessian may be indefinite; it is raised by these parts of its size until it is
  /// not.
  double first_raise = 1e-9, raise_factor = 100, most_raise = 1e6;
  /// A step that is halved this often reaches nothing lower: rounding decides.
  int most_halvings = 20;
  int most_iterations = 50;  ///< a limit: five to ten are the rule
  /// Steps below this [half radians, units of length] change nothing but rounding.
  double least_step = 1e-13;
};

/// The local minimum that Newton's method reaches from these poses.
std::vector<DualQuaternion> minimise_joint(std::span<const JointPair> pairs,
                                           std::vector<DualQuaternion> poses,
                                           const JointOptions& options = {});

/// Standard deviations of the poses of the joint minimum (ConsistentSet::stddev): parts of the drive, the
/// same for all pairs, are omitted from all of them together. edges: the costs of the whole drive; without:
/// the same of the drive without each part; optima: T_a_b of each pair alone.
std::vector<std::array<double, 6>> joint_spread(std::span<const RigEdge> edges,
                                                std::span<const std::vector<RigEdge>> without,
                                                std::span<const DualQuaternion> optima,
                                                const std::vector<DualQuaternion>& poses);

/// What docs/rigs.md proves of a joint minimum.
struct JointProof {
  double pairwise_bound = 0;
  double lower_bound = 0;  ///< of every set of poses
  double rounding = 0;     ///< of the cost in double precision
  bool global = false;     ///< the minimum is proven to be global, up to the rest of its gradient
};

/// Proves what it can of a joint minimum. Empty where not even the bounds of the pairs are proven. poses:
/// unit, up to rounding.
std::optional<JointProof> prove_joint_minimum(std::span<const JointPair> pairs,
                                              const std::vector<DualQuaternion>& poses);

}  // namespace egocal::detail
