// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal_spread.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Covariance by omitting each block, and each pair of neighbours. Of independent errors both are alike;
/// of errors that wander for longer than a block the second one is larger.
struct LeaveOut {
  Matrix6d single = Matrix6d::Zero(), twos = Matrix6d::Zero();

  explicit LeaveOut(const std::vector<Vector6d>& differences) {
    const auto n = static_cast<double>(differences.size());
    Vector6d mean = Vector6d::Zero();
    for (const Vector6d& x : differences) mean += x / n;
    for (const Vector6d& x : differences) single += (n - 1) / n * (x - mean) * (x - mean).transpose();
    for (std::size_t i = 0; i + 1 < differences.size(); i += 2) {
      const Vector6d both = differences[i] + differences[i + 1] - 2 * mean;
      twos += both * both.transpose();
    }
  }
};

/// tr(H C) / 6: how many times larger the variances are than those of white noise, all directions together.
double common_factor(const Matrix6d& H, const Matrix6d& covariance) {
  return (H * covariance).trace() / 6;
}

}  // namespace

std::array<double, 6> goal_spread(const Answered& answered, const GoalSpreadOptions& options) {
  const Observability& reported = answered.observability;
  const Problem& problem = answered.minimised.blocks.empty() ? answered.problem : answered.minimised;
  if (problem.mode == Mode::planar || problem.blocks.size() < options.least_blocks) return reported.stddev;
  const Matrix8d Q = cost_matrix(problem);
  const Matrix86d T = frame_a_basis(answered.T_a_b);
  const Matrix6d H = T.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, answered.T_a_b)) * T;
  const Eigen::LLT<Matrix6d> factors(H);
  if (factors.info() != Eigen::Success) return reported.stddev;
  const Matrix6d white = factors.solve(Matrix6d::Identity());
  const LeaveOut left_out(leave_out_differences(problem, Q, answered.T_a_b));
  const double common = common_factor(H, left_out.single);
  if (!(std::isfinite(common) && common > 0 && white.diagonal().minCoeff() > 0)) return reported.stddev;
  const double wandering = std::max(1.0, common_factor(H, left_out.twos) / common);
  const double own_part = 2 * options.chance;
  std::array<double, 6> spread = reported.stddev;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (!std::isfinite(reported.stddev[i])) continue;
    const double own = std::log(left_out.single(k, k) / (common * white(k, k)));
    const double kept = own * own / (own * own + own_part) * own;
    const double pooled = std::sqrt(wandering * common * white(k, k) * std::exp(kept));
    if (std::isfinite(pooled))
      spread[i] = std::clamp(options.reserve * pooled, reported.stddev[i] / options.most_different,
                             reported.stddev[i] * options.most_different);
  }
  return spread;
}

}  // namespace egocal::detail
