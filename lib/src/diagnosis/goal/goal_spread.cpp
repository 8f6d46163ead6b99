// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal/goal_spread.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal::detail {

namespace {

/// How much the minimum moves when each block is omitted.
struct LeaveOut {
  Vector6d variance = Vector6d::Zero();  ///< of each direction, by the jack-knife
  double mean_factor = 0;  ///< how many times larger they are than H^-1, in the mean of all directions
  double common = 0;       ///< the same with less scatter, from sizes instead of squares

  LeaveOut(const std::vector<Vector6d>& differences, const Matrix6d& H, double unequal) {
    const auto n = static_cast<double>(differences.size());
    Vector6d mean = Vector6d::Zero();
    for (const Vector6d& x : differences) mean += x / n;
    double size = 0;
    for (const Vector6d& x : differences) {
      const Vector6d d = x - mean;
      const double square = std::max(0.0, d.dot(H * d));
      variance += (n - 1) / n * d.cwiseAbs2();
      mean_factor += (n - 1) / n * square / 6;
      size += std::sqrt(square) / n;
    }
    common = unequal * n * size * size / 6;
  }
};

/// What `common` is for white noise of the motions: each tells six numbers, and J is their mean square.
/// Motions of s steps that begin at every instant are as many independent ones as do not overlap.
double common_of_white_noise(const Problem& problem, double J, int stride) {
  double motions = 0, weight = 0, shared = 0, parts = 0;
  for (const Statistics& block : problem.blocks) {
    weight += block.weight;
    if (takes_off(block)) {
      shared -= block.weight;
    } else {
      motions += static_cast<double>(block.count);
      parts += 1;
    }
  }
  // a motion of a sum over strides is in two blocks as often as it is long, in blocks
  const double steps = shared > 0 ? shared / weight * motions / parts : stride;
  return J * std::max(1.0, steps) / (6 * motions);
}

/// The common factor as it is most probable.
struct Factor {
  double value = 0;
  double scatter = 0;    ///< standard deviation of its logarithm
  double wandering = 0;  ///< probability that the noise is not plain
};

/// measured: by omitting blocks. plain: of noise that does not wander. Mean of the logarithm over two
/// hypotheses: it is that of plain noise, up to plain_scatter, or anything within the range.
Factor most_probable(double measured, double plain, double blocks, const GoalSpreadOptions& options) {
  const double above = std::log(measured / plain);
  const double chance = options.scatter * options.scatter * 2 / (6 * blocks);
  const double kinds = options.plain_scatter * options.plain_scatter;
  const double of_plain = options.plain_part * std::exp(-0.5 * above * above / (chance + kinds)) /
                          std::sqrt(2 * std::numbers::pi * (chance + kinds));
  const double of_others = (1 - options.plain_part) / options.range;
  const double wandering = of_others / (of_others + of_plain);
  const double kept = kinds / (chance + kinds);
  const double part = wandering + (1 - wandering) * kept;  // of the deviation, and of its variance
  return {plain * std::exp(part * above), std::sqrt(part * chance), wandering};
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
  const Matrix6d inverse = factors.solve(Matrix6d::Identity());
  const std::vector<Vector6d> differences = leave_out_differences(problem, Q, answered.T_a_b);
  const LeaveOut left_out(differences, H, options.unequal);
  const double plain =
      options.plain * common_of_white_noise(problem, cost(Q, answered.T_a_b), answered.stride);
  const double ratio = left_out.common / plain;
  if (!(plain > 0 && ratio > 0 && std::isfinite(ratio) && inverse.diagonal().minCoeff() > 0))
    return reported.stddev;
  const Factor factor =
      most_probable(left_out.common, plain, static_cast<double>(differences.size()), options);
  const double reserve = std::exp(0.5 * options.reserve * factor.scatter);
  std::array<double, 6> spread = reported.stddev;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (!std::isfinite(reported.stddev[i])) continue;
    const double own = left_out.variance[k] / (left_out.mean_factor * inverse(k, k));
    const double kept = std::pow(own, options.own_part * factor.wandering);
    const double pooled = std::sqrt(factor.value * inverse(k, k) * kept);
    if (std::isfinite(pooled))
      spread[i] = std::clamp(reserve * pooled, reported.stddev[i] / options.most_different,
                             reported.stddev[i] * options.most_different);
  }
  return spread;
}

}  // namespace egocal::detail
