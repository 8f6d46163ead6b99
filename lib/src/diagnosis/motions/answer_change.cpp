// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/answer_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/statistics/median.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// The sums of (16) of consecutive parts of the drive.
using Parts = std::vector<Matrix8d>;

/// Weights of motions by the median of their squared residuals; rows of (14) are half angles and half
/// lengths.
Balance balance_at(const Motions& motions, const Pose& T) {
  std::vector<double> rotations, translations;
  for (const Motion& motion : motions.all) {
    const Residual residual = residual_at(motion, T);
    rotations.push_back(residual.rotation * residual.rotation);
    translations.push_back(residual.translation * residual.translation);
  }
  const auto weight = [](std::vector<double> squares, double typical) {
    constexpr double rounding = 1e-16;  // of the typical motion, squared: eight digits of a pose
    const double square = std::max(median(std::move(squares)), rounding * typical * typical);
    return square > 0 ? 1 / square : 0.0;
  };
  return {weight(std::move(rotations), motions.rotation),
          weight(std::move(translations), motions.translation)};
}

void add(const Motions& motions, const std::vector<double>& weights, const Balance& balance, Parts& parts) {
  const std::size_t n = motions.all.size();
  for (std::size_t part = 0; part < parts.size(); ++part) {
    Statistics sum;
    for (std::size_t i = part * n / parts.size(); i < (part + 1) * n / parts.size(); ++i)
      sum.add(motions.all[i].a, motions.all[i].b, weights[i]);
    if (sum.weight > 0) parts[part] += sum.weight * cost_matrix(sum, balance);
  }
}

Matrix8d sum_without(std::size_t part, const Parts& parts) {
  Matrix8d Q = Matrix8d::Zero();
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i != part) Q += parts[i];
  return Q;
}

/// The answer without one part; of all for parts.size().
DualQuaternion answer_without(std::size_t part, const Parts& parts) {
  const Matrix8d Q = sum_without(part, parts);
  return solve_dual(Q / std::max(Q.trace(), std::numeric_limits<double>::min())).q;
}

Vector6d change_without(std::size_t part, const Parts& parts, const Parts& otherwise) {
  return frame_a_difference(answer_without(part, parts), answer_without(part, otherwise));
}

}  // namespace

std::optional<AnswerChange> answer_change(const Instants& given, const Instants& otherwise,
                                          const DualQuaternion& T_a_b, const AnswerChangeOptions& options) {
  const Pose T = to_pose(T_a_b);
  const std::size_t n = options.parts;
  Parts as_given(n, Matrix8d::Zero()), as_other = as_given;
  for (const int stride : {1, options.longer}) {
    const Motions motions = motions_of(given, {}, {}, stride, options.motions),
                  others = motions_of(otherwise, {}, {}, stride, options.motions);
    if (std::min(motions.all.size(), others.all.size()) < n * options.least) return std::nullopt;
    std::vector<double> weights = robust_fit(motions).weights, of_others = robust_fit(others).weights;
    const bool same = weights.size() == of_others.size();
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i] < options.inlier || (same && of_others[i] < options.inlier)) weights[i] = 0;
    if (same) of_others = weights;
    for (double& weight : of_others)
      if (weight < options.inlier) weight = 0;
    const Balance balance = balance_at(motions, T);
    add(motions, weights, balance, as_given);
    add(others, of_others, balance, as_other);
  }
  std::vector<Vector6d> without;
  Vector6d mean = Vector6d::Zero();
  for (std::size_t part = 0; part < n; ++part) {
    without.push_back(change_without(part, as_given, as_other));
    mean += without.back() / static_cast<double>(n);
  }
  AnswerChange change;
  change.size = change_without(n, as_given, as_other);
  for (const Vector6d& one : without) change.variance += (one - mean).cwiseAbs2();
  change.variance *= static_cast<double>(n - 1) / static_cast<double>(n);
  const auto least_cost = [n](const Parts& parts) {
    return cost(sum_without(n, parts), answer_without(n, parts));
  };
  const double least = least_cost(as_given);
  if (least > 0) change.cost_ratio = least_cost(as_other) / least;
  return change;
}

MiddlePart middle_part(const Trajectory& a, const Trajectory& b, std::size_t most_poses) {
  if (std::max(a.size(), b.size()) <= most_poses) return {a, b};
  const Trajectory& larger = a.size() > b.size() ? a : b;
  const std::size_t first = (larger.size() - most_poses) / 2;
  const std::int64_t from = larger[first].time_us, to = larger[first + most_poses - 1].time_us;
  const auto within = [from, to](const Trajectory& trajectory) {
    const auto earlier = [](const StampedPose& pose, std::int64_t time) { return pose.time_us < time; };
    const auto begin = std::lower_bound(trajectory.begin(), trajectory.end(), from, earlier);
    return Trajectory(begin, std::lower_bound(begin, trajectory.end(), to, earlier));
  };
  return {within(a), within(b)};
}

}  // namespace egocal::detail
